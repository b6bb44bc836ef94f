//! The plain version that the bench stands beside: one queue of cells, and sums along the ways by which it came.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::flow::priority_flood::Flooded;
use weald_core::grid::{Field, Size};

/// Cells above each cell of ground without no-data, by one priority-flood.
pub fn naive(height: &Field) -> Vec<f64> {
    let size = height.size();
    let heights: Vec<f64> = height.values().iter().copied().map(f64::from).collect();
    let outlets: Vec<bool> = (0..size.cells()).map(|cell| size.neighbours(cell).count() < 8).collect();
    let (order, flood) = flooded_by_one_heap(size, &heights, &outlets);
    let mut cells = vec![1.0; size.cells()];
    for &cell in order.iter().rev().filter(|&&cell| flood[cell].next != cell) {
        cells[flood[cell].next] += cells[cell];
    }
    cells
}

/// The cells in the order in which one heap of all cells floods them, and the flood in each.
pub(super) fn flooded_by_one_heap(
    size: Size,
    height: &[f64],
    outlets: &[bool],
) -> (Vec<usize>, Vec<Flooded>) {
    let mut flood: Vec<Option<Flooded>> = vec![None; size.cells()];
    let mut queue = BinaryHeap::new();
    for cell in (0..size.cells()).filter(|&cell| outlets[cell]) {
        flood[cell] = Some(Flooded { level: height[cell], next: cell });
        queue.push(Reverse((Level(height[cell]), cell)));
    }
    let mut order = Vec::with_capacity(size.cells());
    while let Some(Reverse((Level(level), cell))) = queue.pop() {
        order.push(cell);
        for other in size.neighbours(cell) {
            if flood[other].is_none() {
                let level = height[other].max(level);
                flood[other] = Some(Flooded { level, next: cell });
                queue.push(Reverse((Level(level), other)));
            }
        }
    }
    let stranded = |cell: usize| Flooded { level: f64::INFINITY, next: cell };
    let flood = flood.into_iter().enumerate().map(|(cell, flood)| flood.unwrap_or_else(|| stranded(cell)));
    (order, flood.collect())
}

/// A level with the total order of its bits, so that ties fall to the cell number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level(f64);

impl Eq for Level {}

impl PartialOrd for Level {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Level {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Routing, accumulate, route};

    #[test]
    fn the_plain_version_gathers_the_same_water_in_a_valley() {
        let size = Size::new(41, 60).expect("legal");
        let valley = Field::from_function(size, |x, y| 100.0 - y as f32 + 3.0 * (x as f32 - 20.0).abs());
        let ours = accumulate(&route(&valley, None, &Routing::default()).directions, None, None);
        let (mouth, plain) = (size.index(20, 59), naive(&valley));
        // Water takes the way by which the flood came: next to the rim that is the rim, and not the steepest.
        assert!((plain[mouth] / ours[mouth] - 1.0).abs() < 0.25, "{} beside {}", plain[mouth], ours[mouth]);
    }
}
