//! Sizes and fields: the rectangular grids that every stage shares.
//!
//! Row 0 is north, column 0 is west; `x` counts columns eastward, `y` rows southward.

use crate::error::{Error, Limit, Quantity};

/// Most cells that a landscape may hold in memory: 2^28 (16384²), one GiB a layer.
pub const MAX_CELLS: usize = 1 << 28;

/// Most cells along one side.
pub const MAX_SIDE: usize = 1 << 20;

fn subject(columns: usize, rows: usize) -> String {
    format!("a grid of {columns} × {rows} cells")
}

fn ensure_sides(columns: usize, rows: usize) -> Result<(), Limit> {
    let sides = 1..=MAX_SIDE as u64;
    let wrong = [columns, rows].map(|side| side as u64).into_iter().find(|side| !sides.contains(side));
    let Some(side) = wrong else { return Ok(()) };
    let remedy = match side {
        0 => "choose at least one cell a side".to_owned(),
        _ => format!("choose a smaller size, of at most {MAX_CELLS} cells in all"),
    };
    Err(Limit::new(Quantity::CellsPerSide, side, sides).of(subject(columns, rows)).remedy(remedy))
}

/// Columns and rows of a grid, both at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Cells from west to east.
    pub columns: usize,
    /// Cells from north to south.
    pub rows: usize,
}

impl Size {
    /// A checked size: both sides at least 1, at most [`MAX_CELLS`] in all.
    ///
    /// # Errors
    /// [`Error::Limit`] with the side or the cells that are not allowed, and both sides in its subject.
    pub fn new(columns: usize, rows: usize) -> Result<Self, Error> {
        Ok(Self::within_limits(columns, rows)?)
    }

    /// As [`Size::new`], for those who add to the limit what asked for so many cells.
    ///
    /// # Errors
    /// The side or the cells that are not allowed.
    pub fn within_limits(columns: usize, rows: usize) -> Result<Self, Limit> {
        ensure_sides(columns, rows)?;
        let cells = 0..=MAX_CELLS as u64;
        let whole = columns as u64 * rows as u64;
        if !cells.contains(&whole) {
            let limit = Limit::new(Quantity::Cells, whole, cells).of(subject(columns, rows));
            return Err(limit.remedy("choose a smaller size"));
        }
        Ok(Self { columns, rows })
    }

    /// As [`Size::new`], for a grid that is read window by window: at most [`MAX_SIDE`] a side, however many cells those are.
    ///
    /// # Errors
    /// [`Error::Limit`] with the side that is not allowed.
    pub fn on_disk(columns: usize, rows: usize) -> Result<Self, Error> {
        ensure_sides(columns, rows)?;
        Ok(Self { columns, rows })
    }

    /// A square of `side` × `side` cells.
    ///
    /// # Errors
    /// As [`Size::new`].
    pub fn square(side: usize) -> Result<Self, Error> {
        Self::new(side, side)
    }

    /// Number of cells.
    pub fn cells(self) -> usize {
        self.columns * self.rows
    }

    /// Position of cell (`x`, `y`) in row-major order.
    #[inline]
    pub fn index(self, x: usize, y: usize) -> usize {
        y * self.columns + x
    }

    /// Row-major positions of the up to eight neighbours of a cell, in rising order.
    pub fn neighbours(self, cell: usize) -> impl Iterator<Item = usize> {
        let (x, y) = (cell % self.columns, cell / self.columns);
        let rows = y.saturating_sub(1)..(y + 2).min(self.rows);
        let columns = x.saturating_sub(1)..(x + 2).min(self.columns);
        rows.flat_map(move |y| columns.clone().map(move |x| self.index(x, y)))
            .filter(move |&other| other != cell)
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{} × {}", self.columns, self.rows)
    }
}

/// One `f32` for every cell, row-major, row 0 north.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    size: Size,
    values: Vec<f32>,
}

impl Field {
    /// The same value everywhere.
    pub fn filled(size: Size, value: f32) -> Self {
        Self { size, values: vec![value; size.cells()] }
    }

    /// A field from row-major values.
    ///
    /// # Panics
    /// If `values` does not hold one value a cell: a bug of the caller.
    pub fn from_values(size: Size, values: Vec<f32>) -> Self {
        assert_eq!(values.len(), size.cells(), "one value a cell");
        Self { size, values }
    }

    /// A field from a function of column and row.
    pub fn from_function(size: Size, mut value: impl FnMut(usize, usize) -> f32) -> Self {
        let mut values = Vec::with_capacity(size.cells());
        for y in 0..size.rows {
            values.extend((0..size.columns).map(|x| value(x, y)));
        }
        Self { size, values }
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        self.size
    }

    /// All values, row-major.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// All values, row-major.
    pub fn values_mut(&mut self) -> &mut [f32] {
        &mut self.values
    }

    /// The values alone.
    pub fn into_values(self) -> Vec<f32> {
        self.values
    }

    /// Row `y`, from west to east.
    pub fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.size.columns..][..self.size.columns]
    }

    /// Row `y`, from west to east.
    pub fn row_mut(&mut self, y: usize) -> &mut [f32] {
        &mut self.values[y * self.size.columns..][..self.size.columns]
    }

    /// The value of cell (`x`, `y`).
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> f32 {
        self.values[self.size.index(x, y)]
    }

    /// Sets cell (`x`, `y`).
    #[inline]
    pub fn set(&mut self, x: usize, y: usize, value: f32) {
        let index = self.size.index(x, y);
        self.values[index] = value;
    }

    /// Sum in `f64`, row after row, so that it does not depend on threads.
    pub fn sum(&self) -> f64 {
        self.values.chunks(self.size.columns).map(row_sum).sum()
    }

    /// Least and greatest value over the cells of `land` (all cells without one); `None` without a cell.
    pub fn range(&self, valid: Option<&Mask>) -> Option<(f32, f32)> {
        let mut range: Option<(f32, f32)> = None;
        for (index, &value) in self.values.iter().enumerate() {
            if valid.is_none_or(|valid| valid.is_valid_at(index)) {
                let (low, high) = range.unwrap_or((value, value));
                range = Some((low.min(value), high.max(value)));
            }
        }
        range
    }

    /// The first cell that holds a NaN or an infinity, over the cells of `land`.
    pub fn first_not_finite(&self, valid: Option<&Mask>) -> Option<(usize, usize)> {
        // Whole runs are looked at without a branch in vectors.
        let finite = |run: &[f32]| run.iter().fold(true, |all, value| all & value.is_finite());
        let runs = self.values.chunks(RUN).enumerate().filter(|(_, run)| !finite(run));
        let mut cells = runs.flat_map(|(run, values)| (run * RUN..).zip(values));
        let (index, _) = cells.find(|&(index, value)| {
            !value.is_finite() && valid.is_none_or(|valid| valid.is_valid_at(index))
        })?;
        Some((index % self.size.columns, index / self.size.columns))
    }
}

/// Values that are looked at together.
const RUN: usize = 1024;

fn row_sum(row: &[f32]) -> f64 {
    row.iter().map(|&value| f64::from(value)).sum()
}

/// Which cells hold data: `true` is valid, `false` is no-data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    size: Size,
    valid: Vec<bool>,
}

impl Mask {
    /// A mask from row-major flags; `None` where every cell is valid, since then none is needed.
    ///
    /// # Panics
    /// If `land` does not hold one flag a cell: a bug of the caller.
    pub fn new(size: Size, valid: Vec<bool>) -> Option<Self> {
        assert_eq!(valid.len(), size.cells(), "one flag a cell");
        valid.contains(&false).then_some(Self { size, valid })
    }

    /// A mask from row-major flags, also where every cell is valid: for grids in which that may change.
    pub fn always(size: Size, valid: Vec<bool>) -> Self {
        assert_eq!(valid.len(), size.cells(), "one flag a cell");
        Self { size, valid }
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Whether cell (`x`, `y`) holds data.
    pub fn is_valid(&self, x: usize, y: usize) -> bool {
        self.valid[self.size.index(x, y)]
    }

    /// Whether the cell at a row-major position holds data.
    pub fn is_valid_at(&self, index: usize) -> bool {
        self.valid[index]
    }

    /// All flags, row-major.
    pub fn flags(&self) -> &[bool] {
        &self.valid
    }

    /// Number of cells with data.
    pub fn valid_cells(&self) -> usize {
        self.valid.iter().filter(|&&valid| valid).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_up_to_the_limits_are_taken_and_larger_ones_are_refused() {
        for [columns, rows] in [[1, 1], [MAX_SIDE, MAX_CELLS / MAX_SIDE], [MAX_CELLS / MAX_SIDE, MAX_SIDE]] {
            assert_eq!(Size::within_limits(columns, rows), Ok(Size { columns, rows }));
        }
        let (sides, cells) = (1..=1 << 20, 0..=1 << 28);
        // No grid within the sides has just one cell more than 2²⁸: two more are the fewest.
        for ([columns, rows], what, asked, allowed) in [
            ([342, 784_899], Quantity::Cells, (1 << 28) + 2, cells),
            ([(1 << 20) + 1, 1], Quantity::CellsPerSide, (1 << 20) + 1, sides.clone()),
            ([1, 0], Quantity::CellsPerSide, 0, sides),
        ] {
            let limit = Size::within_limits(columns, rows).expect_err("over a limit");
            assert_eq!((limit.what, limit.asked, limit.allowed), (what, Some(asked), allowed));
        }
    }
}
