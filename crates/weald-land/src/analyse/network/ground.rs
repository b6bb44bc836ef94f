//! Ground and water in cells, as all measures of a network want them.

use weald_core::connected::components;
use weald_core::grid::{Mask, Size};

/// A lake is deeper than this, in cells.
const LAKE_DEPTH: f64 = 0.5;

/// And has at least this many cells.
const LAKE_CELLS: usize = 64;

/// Heights and depths in cells.
pub(super) struct Ground<'a> {
    pub(super) size: Size,
    /// Cells with data; all where there is none.
    pub(super) valid: Option<&'a Mask>,
    pub(super) height: Vec<f64>,
    pub(super) depth: Vec<f64>,
}

impl Ground<'_> {
    /// Cells with data, in row-major order.
    pub(super) fn cells(&self) -> impl Iterator<Item = usize> {
        (0..self.size.cells()).filter(|&cell| self.is_valid(cell))
    }

    /// Whether a cell holds data.
    pub(super) fn is_valid(&self, cell: usize) -> bool {
        self.valid.is_none_or(|valid| valid.is_valid_at(cell))
    }

    /// Whether a cell with data lies at the border or beside a cell without.
    pub(super) fn on_rim(&self, cell: usize) -> bool {
        let (x, y) = (cell % self.size.columns, cell / self.size.columns);
        let border = x == 0 || y == 0 || x + 1 == self.size.columns || y + 1 == self.size.rows;
        border || self.size.neighbours(cell).any(|other| !self.is_valid(other))
    }

    /// Which cells belong to a lake.
    pub(super) fn lakes(&self) -> Vec<bool> {
        let deep: Vec<bool> = self.depth.iter().map(|&depth| depth > LAKE_DEPTH).collect();
        let mut lakes = vec![false; self.size.cells()];
        for lake in components(self.size, &deep).into_iter().filter(|lake| lake.len() >= LAKE_CELLS) {
            for cell in lake {
                lakes[cell] = self.is_valid(cell);
            }
        }
        lakes
    }
}
