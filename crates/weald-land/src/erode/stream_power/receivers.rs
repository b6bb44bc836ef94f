//! The receiver of each cell: the neighbour to which the ground falls most steeply.

use rayon::prelude::*;

use super::mesh::Mesh;

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
            || Steepest::new(stride),
            |steepest, (y, (of, inverse))| {
                let first = y * stride;
                if y == 0 || y > mesh.size.rows {
                    of.iter_mut().zip(first..).for_each(|(of, cell)| *of = cell as u32);
                    return;
                }
                steepest.find(mesh, heights, first + 1);
                for (x, (of, inverse)) in of.iter_mut().zip(inverse).enumerate() {
                    let cell = first + x;
                    let within = x > 0 && x + 1 < stride && !base[cell];
                    let direction = if within { steepest.direction[x - 1] } else { NONE };
                    (*of, *inverse) = match direction {
                        NONE => (cell as u32, 0.0),
                        direction => {
                            let direction = usize::from(direction);
                            (
                                cell.wrapping_add_signed(mesh.offset(direction)) as u32,
                                mesh.inverse(cell, direction),
                            )
                        }
                    };
                }
            },
        );
    }
}

/// No neighbour is lower.
const NONE: u8 = u8::MAX;

/// The steepest descents of a row.
struct Steepest {
    slope: Vec<f32>,
    direction: Vec<u8>,
}

impl Steepest {
    fn new(stride: usize) -> Self {
        Self { slope: vec![0.0; stride - 2], direction: vec![NONE; stride - 2] }
    }

    /// Of the row whose first cell that is. Neighbour by neighbour, so that the cells of a row are worked on side by side.
    fn find(&mut self, mesh: &Mesh, heights: &[f64], first: usize) {
        self.slope.fill(0.0);
        self.direction.fill(NONE);
        for direction in 0..8 {
            let here = &heights[first..];
            let there = &heights[first.wrapping_add_signed(mesh.offset(direction))..];
            let inverse = mesh.inverses(first, direction);
            let cells = self.slope.iter_mut().zip(&mut self.direction).zip(here).zip(there).zip(inverse);
            for ((((steepest, steepest_direction), &here), &there), &inverse) in cells {
                // Without data on either side the difference is infinite or no number, which is never kept.
                let slope = (here - there) as f32 * inverse;
                let steeper = slope > *steepest && slope < f32::INFINITY;
                *steepest = if steeper { slope } else { *steepest };
                *steepest_direction = if steeper { direction as u8 } else { *steepest_direction };
            }
        }
    }
}
