//! The plain version that the bench stands beside: one queue of cells, and sums along the ways by which it came.

use crate::flow::priority_flood::priority_flood;
use weald_core::grid::Field;

/// Cells above each cell of ground without no-data, by one priority-flood.
pub fn naive(height: &Field) -> Vec<f64> {
    let size = height.size();
    let heights: Vec<f64> = height.values().iter().copied().map(f64::from).collect();
    let outlets: Vec<bool> = (0..size.cells()).map(|cell| size.neighbours(cell).count() < 8).collect();
    let (order, flood) = priority_flood(size, &heights, &outlets);
    let mut cells = vec![1.0; size.cells()];
    for &cell in order.iter().rev().filter(|&&cell| flood[cell].next != cell) {
        cells[flood[cell].next] += cells[cell];
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Routing, accumulate, route};
    use weald_core::grid::Size;

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
