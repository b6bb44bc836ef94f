//! Where cells lie in a mesh: metres east, up and south from the middle of the domain at height 0.

use super::delaunay::Point;
use super::vector::Vector;
use weald_core::domain::Domain;
use weald_core::grid::Size;

/// The axes of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// Columns and rows of the grid.
    pub(super) size: Size,
    /// Side of a cell in metres.
    pub(super) cell: f64,
}

impl Frame {
    /// The axes for a domain.
    pub(super) fn of(domain: &Domain) -> Self {
        Self { size: domain.size, cell: domain.cell }
    }

    /// The place of a cell's centre at a height. North is towards negative third numbers.
    pub(super) fn place(&self, [x, y]: Point, height: f32) -> Vector {
        let from_middle = |at: u32, count: usize| (f64::from(at) - 0.5 * (count as f64 - 1.0)) * self.cell;
        [from_middle(x, self.size.columns), f64::from(height), from_middle(y, self.size.rows)]
    }

    /// The place of a cell's centre in a texture that covers all cells to their outer edges, from the top left.
    pub(super) fn texture(&self, [x, y]: Point) -> [f32; 2] {
        let share = |at: u32, count: usize| ((f64::from(at) + 0.5) / count as f64) as f32;
        [share(x, self.size.columns), share(y, self.size.rows)]
    }
}
