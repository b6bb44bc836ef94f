//! Creep of soil: dh/dt = D ∇²h, by the nine-point Laplacian that knows no direction to fourth order.

use rayon::prelude::*;

use super::mesh::Mesh;

/// Share of a cell that each neighbour counts: along the axes, and the diagonals.
const WEIGHTS: [f64; 8] =
    [2.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0];

/// Greatest D dt / cell² of a pass: stable up to 3/8 for what alternates along the axes.
const MOST_EXCHANGED: f64 = 0.3;

/// Lets the ground creep by `reach` = D dt, in m². Cells of the base level keep their height, and nothing passes to where
/// there is no data. `spare` is as long as `heights`, of which it takes the place.
pub(super) fn creep(mesh: &Mesh, heights: &mut Vec<f64>, spare: &mut Vec<f64>, base: &[bool], reach: f64) {
    let whole = reach / mesh.area;
    if whole <= 0.0 {
        return;
    }
    let passes = (whole / MOST_EXCHANGED).ceil();
    for _ in 0..passes as u64 {
        pass(mesh, heights, spare, base, whole / passes);
        std::mem::swap(heights, spare);
    }
}

fn pass(mesh: &Mesh, heights: &[f64], after: &mut [f64], base: &[bool], share: f64) {
    let stride = mesh.stride;
    after.par_chunks_mut(stride).enumerate().for_each(|(y, row)| {
        let first = y * stride;
        row.copy_from_slice(&heights[first..first + stride]);
        if y == 0 || y > mesh.size.rows {
            return;
        }
        let row = &mut row[1..stride - 1];
        let here = &heights[first + 1..];
        for (direction, weight) in WEIGHTS.iter().enumerate() {
            let there = &heights[(first + 1).wrapping_add_signed(mesh.offset(direction))..];
            for ((after, &here), &there) in row.iter_mut().zip(here).zip(there) {
                let gain = share * weight * (there - here);
                *after += if gain.is_finite() { gain } else { 0.0 };
            }
        }
        for ((after, &here), _) in row.iter_mut().zip(here).zip(&base[first + 1..]).filter(|(_, base)| **base)
        {
            *after = here;
        }
    });
}
