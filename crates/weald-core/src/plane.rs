//! Planes of a grid that need not be in memory: they are read and written window by window.

use std::ops::Range;

use crate::error::Error;
use crate::grid::Size;

/// Part of a grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Window {
    /// Columns.
    pub columns: Range<usize>,
    /// Rows.
    pub rows: Range<usize>,
}

impl Window {
    /// The whole of a grid.
    pub fn whole(size: Size) -> Self {
        Self { columns: 0..size.columns, rows: 0..size.rows }
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        Size { columns: self.columns.len(), rows: self.rows.len() }
    }

    /// The same with so many cells more on every side, as far as the grid goes.
    #[must_use]
    pub fn grown(&self, margin: usize, grid: Size) -> Self {
        let grown = |side: &Range<usize>, end: usize| {
            side.start.saturating_sub(margin)..side.end.saturating_add(margin).min(end)
        };
        Self { columns: grown(&self.columns, grid.columns), rows: grown(&self.rows, grid.rows) }
    }
}

/// One value for every cell of a grid, in memory or elsewhere.
pub trait Plane<T> {
    /// Columns and rows.
    fn size(&self) -> Size;

    /// The values of a window within the grid, row-major.
    ///
    /// # Errors
    /// [`Error::Run`] where they cannot be read from where they lie.
    fn read(&self, window: &Window) -> Result<Vec<T>, Error>;

    /// Replaces the values of a window within the grid, given row-major.
    ///
    /// # Errors
    /// [`Error::Run`] where they cannot be written.
    fn write(&mut self, window: &Window, values: &[T]) -> Result<(), Error>;
}

/// A plane in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldPlane<T> {
    size: Size,
    values: Vec<T>,
}

impl<T> HeldPlane<T> {
    /// A plane of row-major values.
    ///
    /// # Panics
    /// If `values` does not hold one value a cell: a bug of the caller.
    pub fn new(size: Size, values: Vec<T>) -> Self {
        assert_eq!(values.len(), size.cells(), "one value a cell");
        Self { size, values }
    }

    /// All values, row-major.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    fn places(&self, window: &Window) -> impl Iterator<Item = Range<usize>> + use<T> {
        let (columns, count, first) = (self.size.columns, window.columns.len(), window.columns.start);
        window.rows.clone().map(move |y| y * columns + first..y * columns + first + count)
    }
}

impl<T: Copy> Plane<T> for HeldPlane<T> {
    fn size(&self) -> Size {
        self.size
    }

    fn read(&self, window: &Window) -> Result<Vec<T>, Error> {
        let mut values = Vec::with_capacity(window.size().cells());
        self.places(window).for_each(|row| values.extend_from_slice(&self.values[row]));
        Ok(values)
    }

    fn write(&mut self, window: &Window, values: &[T]) -> Result<(), Error> {
        for (row, from) in self.places(window).zip(values.chunks_exact(window.columns.len())) {
            self.values[row].copy_from_slice(from);
        }
        Ok(())
    }
}

/// A window of a plane with so many cells more on every side, row-major; `outside` where those lie beyond the grid.
///
/// # Errors
/// As [`Plane::read`].
pub fn read_around<T: Copy>(
    plane: &dyn Plane<T>,
    window: &Window,
    margin: usize,
    outside: T,
) -> Result<Vec<T>, Error> {
    let inside = window.grown(margin, plane.size());
    let values = plane.read(&inside)?;
    let columns = window.columns.len() + 2 * margin;
    let mut around = vec![outside; columns * (window.rows.len() + 2 * margin)];
    let west = margin - (window.columns.start - inside.columns.start);
    let north = margin - (window.rows.start - inside.rows.start);
    let rows = around.chunks_exact_mut(columns).skip(north);
    for (row, from) in rows.zip(values.chunks_exact(inside.columns.len())) {
        row[west..west + from.len()].copy_from_slice(from);
    }
    Ok(around)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_to_a_window_is_read_from_those_that_overlap_it() {
        let size = Size { columns: 4, rows: 3 };
        let mut plane = HeldPlane::new(size, (0..12_u8).collect());
        plane.write(&Window { columns: 1..3, rows: 1..3 }, &[50, 60, 90, 100]).expect("in memory");
        assert_eq!(plane.values(), [0, 1, 2, 3, 4, 50, 60, 7, 8, 90, 100, 11]);
        let corner = Window { columns: 0..1, rows: 2..3 };
        assert_eq!(
            read_around(&plane, &corner, 1, 255).expect("in memory"),
            [255, 4, 50, 255, 8, 90, 255, 255, 255]
        );
        assert_eq!(read_around(&plane, &corner, 0, 255).expect("in memory"), [8]);
    }
}
