//! Creep of soil: dh/dt = D ∇²h, by the nine-point Laplacian that knows no direction to fourth order.
//!
//! What creeps into a river the river carries off. It is narrower than its cell, and soil that was laid down over all of the cell
//! would make it the steeper the smaller the cells are: the banks bring the same, but to less ground (Perron, Dietrich and
//! Kirchner 2008, doi 10.1029/2007JF000977; Pelletier 2010, doi 10.1016/j.geomorph.2010.06.001).

use rayon::prelude::*;

use super::mesh::Mesh;
use weald_core::vectors;

/// Share of a cell that each neighbour along the axes counts, and each along the diagonals.
const ALONG_AXES: f64 = 2.0 / 3.0;
const ALONG_DIAGONALS: f64 = 1.0 / 6.0;

/// Greatest D dt / cell² of a pass: stable up to 3/8 for what alternates along the axes.
const MOST_EXCHANGED: f64 = 0.3;

/// Passes between two looks for whether the ground still creeps: a look reads as much as a pass does.
const BETWEEN_LOOKS: u64 = 16;

/// Part of the largest height by which ground at rest may change in a pass: where nothing drains, heights go round in their last
/// bits for ever. What is left to creep then is too little to matter: on 4,096 cells in a row, of 1,000 m, some micrometres.
const AT_REST: f64 = 2.0 * f64::EPSILON;

/// Cells below which a pass is not shared among threads: they would wait for each other for longer than they work.
const SHARED_FROM: usize = 4_096;

/// Slopes that creep, and the rivers between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes<'a> {
    pub(super) mesh: &'a Mesh,
    /// Cells whose height does not change.
    pub(super) base: &'a [bool],
    /// Upslope area of each cell in m², and how much of it a river has at least.
    pub(super) area: &'a [f64],
    pub(super) river_from: f64,
}

impl Slopes<'_> {
    /// Lets the ground creep by `reach` = D dt, in m². Cells of the base level keep their height, and nothing passes to where
    /// there is no data. `spare` is as long as `heights`, of which it takes the place; what creeps into each cell with a river
    /// is added to `carried_off`, in metres. Ground that has come to rest is left so: small cells may ask for millions of
    /// passes. Gives how many were made.
    pub(super) fn creep(
        &self,
        reach: f64,
        (heights, spare): (&mut Vec<f64>, &mut Vec<f64>),
        carried_off: &mut [f64],
    ) -> u64 {
        let whole = reach / self.mesh.area;
        let passes = (whole / MOST_EXCHANGED).ceil() as u64;
        for pass in 1..=passes {
            self.pass(heights, (spare, carried_off), whole / passes as f64);
            std::mem::swap(heights, spare);
            if pass % BETWEEN_LOOKS == 0 && is_at_rest(heights, spare) {
                return pass;
            }
        }
        passes
    }

    fn pass(&self, heights: &[f64], (after, carried_off): (&mut [f64], &mut [f64]), share: f64) {
        let stride = self.mesh.stride;
        let rows = after.par_chunks_mut(stride).zip(carried_off.par_chunks_mut(stride)).enumerate();
        rows.with_min_len(SHARED_FROM.div_ceil(stride)).for_each(|(y, (row, carried_off))| {
            let first = y * stride;
            let here = &heights[first..first + stride];
            row.copy_from_slice(here);
            if y == 0 || y > self.mesh.size.rows {
                return;
            }
            let around =
                [&heights[first - stride..first], here, &heights[first + stride..first + 2 * stride]];
            let area = &self.area[first..first + stride];
            vectors::widest(
                #[inline(always)]
                || {
                    exchange(around, row, share);
                    take_away(here, row, (area, self.river_from), carried_off);
                },
            );
            for (x, _) in self.base[first..first + stride].iter().enumerate().filter(|(_, base)| **base) {
                row[x] = here[x];
                carried_off[x] = 0.0;
            }
        });
    }
}

/// Whether no height is other than before by more than rounding makes it.
fn is_at_rest(heights: &[f64], before: &[f64]) -> bool {
    let with_data = || heights.iter().zip(before).filter(|(height, _)| height.is_finite());
    let highest = with_data().fold(0.0, |highest: f64, (height, _)| highest.max(height.abs()));
    with_data().all(|(height, before)| (height - before).abs() <= AT_REST * highest)
}

/// What the cells of a row are after they have given and taken.
#[inline(always)]
fn exchange(around: [&[f64]; 3], after: &mut [f64], share: f64) {
    let cells = after.len() - 2;
    let [[nw, n, ne], [w, here, e], [sw, s, se]] =
        around.map(|row| [0, 1, 2].map(|from| &row[from..][..cells]));
    for (x, after) in after[1..=cells].iter_mut().enumerate() {
        let gain = |there: &[f64]| {
            let gain = there[x] - here[x];
            if gain.is_finite() { gain } else { 0.0 }
        };
        let axes = (gain(w) + gain(e)) + (gain(n) + gain(s));
        let diagonals = (gain(nw) + gain(se)) + (gain(ne) + gain(sw));
        *after = here[x] + share * (ALONG_AXES * axes + ALONG_DIAGONALS * diagonals);
    }
}

/// Gives rivers what the cells of a row have gained.
#[inline(always)]
fn take_away(before: &[f64], after: &mut [f64], (area, river_from): (&[f64], f64), carried_off: &mut [f64]) {
    let cells = after.iter_mut().zip(before).zip(area).zip(carried_off);
    for (((after, &before), &area), carried_off) in cells {
        let gained = if area > river_from && *after > before { *after - before } else { 0.0 };
        *after -= gained;
        *carried_off += gained;
    }
}
