//! How much of the land drains without a pit on the way.

use super::ground::Ground;
use crate::flow::priority_flood::priority_flood;

/// A pit deeper than this, in cells, cuts off the land above it.
const PIT_DEPTH: f64 = 0.5;

/// Share of the land outside lakes from which the flood's path to a lake or the rim crosses no deep pit.
pub(super) fn draining_share(ground: &Ground<'_>, lakes: &[bool]) -> f64 {
    let surface = |cell: usize| match (ground.is_valid(cell), lakes[cell]) {
        (false, _) => f64::INFINITY,
        (true, true) => ground.height[cell] + ground.depth[cell],
        (true, false) => ground.height[cell],
    };
    let size = ground.size;
    let surface: Vec<f64> = (0..size.cells()).map(surface).collect();
    let is_outlet = |cell: usize| ground.is_valid(cell) && (lakes[cell] || ground.on_rim(cell));
    let outlets: Vec<bool> = (0..size.cells()).map(is_outlet).collect();
    let (order, flood) = priority_flood(size, &surface, &outlets);
    let mut passes = vec![true; size.cells()];
    let (mut land, mut draining) = (0_usize, 0_usize);
    for cell in order.into_iter().filter(|&cell| ground.is_valid(cell)) {
        let filled = flood[cell].level - surface[cell];
        passes[cell] = passes[flood[cell].next] && filled <= PIT_DEPTH;
        if !lakes[cell] {
            land += 1;
            draining += usize::from(passes[cell]);
        }
    }
    draining as f64 / land.max(1) as f64
}

/// Inner cells without a lower neighbour among eight.
pub(super) fn pits(ground: &Ground<'_>) -> usize {
    let inner = ground.cells().filter(|&cell| !ground.on_rim(cell));
    let height = &ground.height;
    inner.filter(|&cell| ground.size.neighbours(cell).all(|other| height[other] >= height[cell])).count()
}
