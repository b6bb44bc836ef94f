//! Priority-flood: how high water must stand in every cell to find its path to an outlet.
//!
//! Outlets enter a queue ordered by level; the lowest cell leaves it, and each new neighbour enters at
//! `max(its height, the level of the cell it is reached from)`. Source: Barnes, Lehman and Mulla 2014,
//! "Priority-flood: An optimal depression-filling and watershed-labeling algorithm for digital elevation
//! models", doi 10.1016/j.cageo.2013.04.024, algorithm 1. Differs: outlets may lie inside the grid (lakes),
//! and the cell from which each cell was reached is kept, so that paths to the outlets can be judged.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use weald_core::grid::Size;

/// Where a cell's water goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flooded {
    /// Level at which water stands when it runs off.
    pub(crate) level: f64,
    /// The next cell on the path to an outlet; the cell itself for an outlet.
    pub(crate) next: usize,
}

/// The cells in the order in which they were flooded, and the flood in each cell.
pub(crate) fn priority_flood(size: Size, height: &[f64], outlets: &[bool]) -> (Vec<usize>, Vec<Flooded>) {
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

    #[test]
    fn a_bowl_fills_to_its_lowest_rim() {
        let size = Size::square(5).expect("legal");
        let mut height = vec![9.0; 25];
        for cell in [6, 7, 8, 11, 12, 13, 16, 17, 18] {
            height[cell] = 1.0;
        }
        height[2] = 4.0;
        let border: Vec<bool> =
            (0..25).map(|cell| ![6, 7, 8, 11, 12, 13, 16, 17, 18].contains(&cell)).collect();
        let (order, flood) = priority_flood(size, &height, &border);
        assert_eq!(order.len(), 25);
        assert_eq!(flood[12].level, 4.0);
        assert_eq!(flood[6].level, 4.0);
        assert_eq!(flood[0].level, 9.0);
    }
}
