//! The points between which rivers run: one a cell, moved off its middle.
//!
//! On the middles themselves a river knows eight directions only, and ridges, valleys and whole slopes lie along them.
//! Points that are moved at random have neighbours in all directions, and paths over them are too long by the same share
//! whichever direction they take, as on the irregular meshes of landscape evolution (Braun and Sambridge 1997, doi
//! 10.1046/j.1365-2117.1997.00030.x). A cell keeps its area.
//!
//! A ring of cells without data lies around the grid, so that the border of the grid and of the data are one thing.

use rayon::prelude::*;

use crate::flow::directions::STEPS;
use weald_core::domain::Domain;
use weald_core::grid::Size;
use weald_core::random::{hash2, unit};

/// Steps of which each edge between two cells is one, seen from its northern or western end: east, south-east, south and
/// south-west. The other four lead back.
const EDGES: usize = 4;

/// Cells in a ring, and the distances of their points.
#[derive(Debug)]
pub(in crate::erode) struct Mesh {
    /// Size of the grid within the ring.
    pub(super) size: Size,
    /// Cells in a row, with the ring.
    pub(super) stride: usize,
    /// Area of a cell in m².
    pub(super) area: f64,
    /// Side of a cell.
    pub(super) cell: f64,
    /// One over the length of each edge, in 1/m.
    inverse: [Vec<f32>; EDGES],
}

impl Mesh {
    /// A mesh whose points lie up to half of `irregularity` cells off the middles, along each axis.
    pub(in crate::erode) fn new(domain: &Domain, irregularity: f64, seed: u64) -> Self {
        let (size, cell) = (domain.size, domain.cell);
        let stride = size.columns + 2;
        let point = |x: i64, y: i64| {
            let bits = hash2(seed, x, y);
            let off = [unit(bits), unit(bits << 32)].map(|share| irregularity * (share - 0.5));
            [x as f64 + off[0], y as f64 + off[1]]
        };
        let inverse = std::array::from_fn(|edge| {
            let (east, south) = STEPS[edge];
            let mut inverse = vec![0.0; stride * (size.rows + 2)];
            inverse.par_chunks_mut(stride).enumerate().for_each(|(y, row)| {
                for (x, inverse) in row.iter_mut().enumerate() {
                    let (x, y) = (x as i64, y as i64);
                    let (here, there) = (point(x, y), point(x + east as i64, y + south as i64));
                    let along = [there[0] - here[0], there[1] - here[1]];
                    *inverse = (1.0 / (cell * libm::sqrt(along[0] * along[0] + along[1] * along[1]))) as f32;
                }
            });
            inverse
        });
        Self { size, stride, area: cell * cell, cell, inverse }
    }

    /// Number of cells, with the ring.
    pub(super) fn cells(&self) -> usize {
        self.stride * (self.size.rows + 2)
    }

    /// Difference of cell numbers to a neighbour.
    pub(super) fn offset(&self, direction: usize) -> isize {
        let (east, south) = STEPS[direction];
        south * self.stride as isize + east
    }

    /// The eight neighbours of a cell within the ring.
    pub(super) fn around(&self, cell: usize) -> [usize; 8] {
        std::array::from_fn(|direction| cell.wrapping_add_signed(self.offset(direction)))
    }

    /// One over the distances of the cells from `first` on to their neighbours in one direction, in 1/m.
    pub(super) fn inverses(&self, first: usize, direction: usize) -> &[f32] {
        let first = if direction < EDGES { first } else { first.wrapping_add_signed(self.offset(direction)) };
        &self.inverse[direction % EDGES][first..]
    }

    /// One over the distance of a cell to a neighbour, in 1/m.
    pub(super) fn inverse(&self, cell: usize, direction: usize) -> f32 {
        self.inverses(cell, direction)[0]
    }

    /// The direction in which a neighbour lies.
    pub(super) fn direction(&self, from: usize, to: usize) -> usize {
        self.around(from).iter().position(|&beside| beside == to).expect("neighbours lie beside each other")
    }

    /// Cells of the grid, row by row, as numbers of cells in the ring.
    pub(super) fn inner(&self) -> impl Iterator<Item = usize> + '_ {
        (1..=self.size.rows).flat_map(|y| (y * self.stride + 1..).take(self.size.columns))
    }

    /// Values of the grid, with `outside` in the ring.
    pub(super) fn ringed<T: Copy>(&self, outside: T, mut value: impl FnMut(usize, usize) -> T) -> Vec<T> {
        let mut ringed = vec![outside; self.cells()];
        let cells: Vec<_> = self.inner().collect();
        for (at, cell) in cells.into_iter().enumerate() {
            ringed[cell] = value(at % self.size.columns, at / self.size.columns);
        }
        ringed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_as_long_from_both_ends_and_its_mean_knows_no_direction() {
        let domain = Domain::new(Size { columns: 90, rows: 80 }, 10.0);
        let mesh = Mesh::new(&domain, 0.8, 5);
        for cell in [200, 3000, 5555] {
            for (direction, beside) in mesh.around(cell).into_iter().enumerate() {
                assert_eq!(mesh.inverse(cell, direction), mesh.inverse(beside, (direction + 4) % 8));
                assert_eq!(mesh.direction(cell, beside), direction);
            }
        }
        let regular = Mesh::new(&domain, 0.0, 5);
        assert_eq!(regular.inverse(300, 0), 0.1);
        assert!((f64::from(regular.inverse(300, 1)) - 0.1 / 2.0_f64.sqrt()).abs() < 1e-8);
    }
}
