//! The longest connected valley: cells that lie deepest below their surroundings, or were carved deepest.

use super::ground::Ground;
use crate::analyse::gaussian::{Grid, gaussian};
use weald_core::connected::{components, geodesic_length};

/// Standard deviation, in cells, of the mean that valleys lie below.
const SURROUNDINGS: f64 = 3.0;

/// Share of the cells that count as valley.
const VALLEY_SHARE: f64 = 0.05;

/// The largest of connected parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Connected {
    /// Its length over the longer side of the grid.
    pub(super) reach: f64,
    /// Its share of the cells of all parts.
    pub(super) largest: f64,
}

/// The twentieth of the land that lies deepest below the mean of its surroundings.
pub(super) fn valleys(ground: &Ground<'_>) -> Connected {
    let mean = surroundings(ground);
    let below: Vec<f64> = mean.iter().zip(&ground.height).map(|(mean, height)| mean - height).collect();
    deepest(ground, &below)
}

/// The twentieth of the land with the greatest depths, as far as they are above 0.
pub(super) fn deepest(ground: &Ground<'_>, depth: &[f64]) -> Connected {
    let mut sorted: Vec<f64> = ground.cells().map(|cell| depth[cell]).collect();
    if sorted.is_empty() {
        return Connected::default();
    }
    let place = ((1.0 - VALLEY_SHARE) * sorted.len() as f64) as usize;
    let least = *sorted.select_nth_unstable_by(place, f64::total_cmp).1;
    let mut member = vec![false; ground.size.cells()];
    for cell in ground.cells() {
        member[cell] = depth[cell] >= least && depth[cell] > 0.0;
    }
    connected(ground, &member)
}

fn connected(ground: &Ground<'_>, member: &[bool]) -> Connected {
    let components = components(ground.size, member);
    let Some(largest) = components.iter().max_by_key(|component| component.len()) else {
        return Connected::default();
    };
    let cells: usize = components.iter().map(Vec::len).sum();
    let side = ground.size.columns.max(ground.size.rows) as f64;
    Connected {
        reach: geodesic_length(ground.size, largest) as f64 / side,
        largest: largest.len() as f64 / cells as f64,
    }
}

/// Gaussian mean of the land around each cell.
fn surroundings(ground: &Ground<'_>) -> Vec<f64> {
    let blurred = |value: &dyn Fn(usize) -> f64| {
        let values = (0..ground.size.cells()).map(value).collect();
        gaussian(&Grid { columns: ground.size.columns, values }, SURROUNDINGS).values
    };
    let valid = |cell: usize| if ground.is_valid(cell) { ground.height[cell] } else { 0.0 };
    let heights = blurred(&valid);
    if ground.valid.is_none() {
        return heights;
    }
    let weights = blurred(&|cell| f64::from(u8::from(ground.is_valid(cell))));
    heights.iter().zip(weights).map(|(height, weight)| height / weight).collect()
}
