//! The sea as it stands on ground that rises and sinks.

use super::lakes::Lakes;
use super::mesh::Mesh;
use weald_core::sea;

/// Raises the level of the water to that of the sea wherever the sea reaches.
pub(super) fn flood(mesh: &Mesh, heights: &[f64], sea_level: f64, water: &mut Lakes) {
    let inner: Vec<_> = mesh.inner().collect();
    let height = |cell: usize| heights[inner[cell]];
    let reached = sea::reach(mesh.size, |cell| height(cell) <= sea_level, |cell| height(cell).is_finite());
    if !water.stand {
        water.level.fill(f64::NEG_INFINITY);
        water.stand = true;
    }
    for (&cell, _) in inner.iter().zip(&reached).filter(|(_, reached)| **reached) {
        water.level[cell] = water.level[cell].max(sea_level);
    }
}
