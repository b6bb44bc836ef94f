//! Heights in a ring of no-data, so that the border of the grid and of the data are one thing.

use rayon::prelude::*;

use crate::flow::directions::STEPS;
use weald_core::grid::{Field, Mask, Size};
use weald_core::sea;

/// Level of a cell without data: nothing flows there, and who is beside it can let water out.
pub(super) const NO_DATA: f32 = f32::INFINITY;

/// Level of a cell of the sea: everything flows there.
pub(super) const SEA_LEVEL: f32 = f32::NEG_INFINITY;

/// Rows that one task works on; no result depends on it.
pub(super) const ROWS_PER_TASK: usize = 16;

/// A grid with one more cell on every side.
#[derive(Debug)]
pub(super) struct Surface {
    /// Size of the grid within the ring.
    pub(super) size: Size,
    /// Cells in a row, with the ring.
    pub(super) stride: usize,
    /// Height of each cell, with the ring.
    pub(super) level: Vec<f32>,
    /// Of part of a grid: which cells of the ring lie elsewhere and have data, so that no water is lost there. Empty for a
    /// whole grid.
    pub(super) elsewhere: Vec<bool>,
}

impl Surface {
    pub(super) fn of(height: &Field, valid: Option<&Mask>, sea_level: Option<f64>) -> Self {
        let size = height.size();
        let stride = size.columns + 2;
        let mut level = vec![NO_DATA; stride * (size.rows + 2)];
        let rows = level.par_chunks_mut(stride).with_min_len(ROWS_PER_TASK).skip(1).take(size.rows);
        rows.enumerate().for_each(|(y, row)| {
            for (x, level) in row[1..=size.columns].iter_mut().enumerate() {
                if valid.is_none_or(|valid| valid.is_valid(x, y)) {
                    *level = height.at(x, y);
                    assert!(level.is_finite(), "the height in column {x}, row {y} is {level}");
                }
            }
        });
        let mut surface = Self { size, stride, level, elsewhere: Vec::new() };
        if let Some(sea_level) = sea_level {
            surface.flood(height, valid, sea_level as f32);
        }
        surface
    }

    /// Number of cells, with the ring.
    pub(super) fn cells(&self) -> usize {
        self.level.len()
    }

    /// Difference of cell numbers to the eight neighbours, in the order of their codes.
    pub(super) fn offsets(&self) -> [isize; 8] {
        STEPS.map(|(east, south)| south * self.stride as isize + east)
    }

    pub(super) fn has_data(&self, cell: usize) -> bool {
        self.level[cell] != NO_DATA
    }

    /// Whether water leaves over this cell from those around it.
    #[inline]
    pub(super) fn lets_out(&self, cell: usize) -> bool {
        !self.has_data(cell) && (self.elsewhere.is_empty() || !self.elsewhere[cell])
    }

    pub(super) fn is_sea(&self, cell: usize) -> bool {
        self.level[cell] == SEA_LEVEL
    }

    /// The neighbour in the direction of a code.
    #[inline]
    pub(super) fn neighbour(&self, cell: usize, code: u8) -> usize {
        let (east, south) = STEPS[usize::from(code) - 1];
        cell.wrapping_add_signed(south * self.stride as isize + east)
    }

    /// The eight neighbours of a cell within the ring, in the order of their codes.
    #[inline]
    pub(super) fn around(&self, cell: usize) -> [usize; 8] {
        self.offsets().map(|offset| cell.wrapping_add_signed(offset))
    }

    /// What lies within the ring, changed by a function of cell and value.
    pub(super) fn inner<T, U>(&self, values: &[T], change: impl Fn(usize, T) -> U + Sync) -> Vec<U>
    where
        T: Copy + Sync,
        U: Copy + Default + Send,
    {
        let mut inner = vec![U::default(); self.size.cells()];
        let rows = inner.par_chunks_mut(self.size.columns).with_min_len(ROWS_PER_TASK);
        rows.enumerate().for_each(|(y, row)| {
            let first = (y + 1) * self.stride + 1;
            for (x, (to, &from)) in row.iter_mut().zip(&values[first..]).enumerate() {
                *to = change(first + x, from);
            }
        });
        inner
    }

    /// Takes all of the sea to its level.
    fn flood(&mut self, height: &Field, valid: Option<&Mask>, sea_level: f32) {
        let has_data = |cell: usize| valid.is_none_or(|valid| valid.is_valid_at(cell));
        let sea = sea::reach(self.size, |cell| height.values()[cell] <= sea_level, has_data);
        for (cell, _) in sea.iter().enumerate().filter(|(_, is_sea)| **is_sea) {
            let (x, y) = (cell % self.size.columns, cell / self.size.columns);
            self.level[(y + 1) * self.stride + x + 1] = SEA_LEVEL;
        }
    }
}
