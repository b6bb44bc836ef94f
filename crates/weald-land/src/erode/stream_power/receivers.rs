//! The receiver of each cell: the neighbour to which the ground falls most steeply.

use rayon::prelude::*;

use super::mesh::Mesh;
use weald_core::vectors;

/// Where each cell drains to.
#[derive(Debug)]
pub(super) struct Receivers {
    /// The number of the receiver; a cell that drains nowhere is its own.
    pub(super) of: Vec<u32>,
    /// One over the distance to it, in 1/m.
    pub(super) inverse: Vec<f32>,
}

impl Receivers {
    /// None yet.
    pub(super) fn none(mesh: &Mesh) -> Self {
        Self { of: vec![0; mesh.cells()], inverse: vec![0.0; mesh.cells()] }
    }

    /// Finds them anew on heights in metres, infinite where there is no data. Cells of the base level drain nowhere.
    pub(super) fn find(&mut self, mesh: &Mesh, heights: &[f64], base: &[bool]) {
        let stride = mesh.stride;
        let rows = self.of.par_chunks_mut(stride).zip(self.inverse.par_chunks_mut(stride));
        rows.enumerate().for_each_init(
            || vec![0.0; stride],
            |slopes, (y, (of, inverse))| {
                let first = y * stride;
                let drain_nowhere = |of: &mut [u32], inverse: &mut [f32]| {
                    of.iter_mut().zip(first as u32..).for_each(|(of, cell)| *of = cell);
                    inverse.fill(0.0);
                };
                drain_nowhere(of, inverse);
                if y > 0 && y <= mesh.size.rows {
                    slopes.fill(0.0);
                    let inner = 1..stride - 1;
                    let (of, inverse) = (&mut of[inner.clone()], &mut inverse[inner.clone()]);
                    Steepest { slopes: &mut slopes[inner], of, inverse }.find(mesh, heights, first + 1);
                }
                for (x, _) in base[first..first + stride].iter().enumerate().filter(|(_, base)| **base) {
                    (of[x], inverse[x]) = ((first + x) as u32, 0.0);
                }
            },
        );
    }
}

/// The steepest descents of a row that were met up to now.
struct Steepest<'a> {
    slopes: &'a mut [f32],
    of: &'a mut [u32],
    inverse: &'a mut [f32],
}

impl Steepest<'_> {
    /// Of the row whose first cell that is. Neighbour by neighbour, so that the cells of a row are worked on side by side.
    fn find(&mut self, mesh: &Mesh, heights: &[f64], first: usize) {
        vectors::widest(
            #[inline(always)]
            || {
                for direction in 0..8 {
                    let beside = first.wrapping_add_signed(mesh.offset(direction));
                    let inverses = mesh.inverses(first, direction);
                    self.look(&heights[first..], (&heights[beside..], beside as u32), inverses);
                }
            },
        );
    }

    #[inline(always)]
    fn look(&mut self, here: &[f64], (there, number): (&[f64], u32), inverses: &[f32]) {
        let found = self.slopes.iter_mut().zip(&mut *self.of).zip(&mut *self.inverse).zip(number..);
        for ((((steepest, of), to), number), ((&here, &there), &inverse)) in
            found.zip(here.iter().zip(there).zip(inverses))
        {
            // Without data on either side the difference is infinite or no number, which is never kept.
            let slope = (here - there) as f32 * inverse;
            let steeper = slope > *steepest && slope < f32::INFINITY;
            *steepest = if steeper { slope } else { *steepest };
            *of = if steeper { number } else { *of };
            *to = if steeper { inverse } else { *to };
        }
    }
}
