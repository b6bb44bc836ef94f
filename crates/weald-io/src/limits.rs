//! What a reader finds wrong with the bytes of a file, before it knows the file's name; and what it may use, so that no file, however damaged, takes more memory than its size warrants.

use std::path::Path;

use super::memory::{available, has_addresses};
use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::{MAX_CELLS, Size};

/// What is wrong with the bytes of a file; [`Fault::of`] adds the name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The bytes are damaged or of a kind that is not read.
    #[error("{0}")]
    Damaged(String),
    /// A stated limit would be passed; nothing was allocated.
    #[error("{0}")]
    Limit(#[from] Limit),
}

impl Fault {
    /// Damaged bytes.
    pub fn damaged(what: impl Into<String>) -> Self {
        Self::Damaged(what.into())
    }

    /// The error of the file at `path`.
    #[must_use]
    pub fn of(self, path: &Path) -> Error {
        match self {
            Self::Damaged(what) => Error::input(path, what),
            Self::Limit(limit) => limit.of(path.display()).into(),
        }
    }
}

/// Deflate expands at most 1032 times, LZW with codes of 12 bits about 1350 times.
pub(super) const MAX_EXPANSION: usize = 2048;

/// What a reader may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Most cells of a raster.
    pub cells: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { cells: MAX_CELLS }
    }
}

impl Limits {
    /// The size in a header, once it is known to be within limits.
    ///
    /// # Errors
    /// [`Fault::Limit`] with both sides in its subject; [`Fault::Damaged`] for a grid without a cell.
    pub fn size(self, columns: usize, rows: usize) -> Result<Size, Fault> {
        if columns == 0 || rows == 0 {
            return Err(Fault::damaged(format!("{columns} × {rows} cells: there is nothing in it")));
        }
        let size = Size::within_limits(columns, rows)?;
        if size.cells() > self.cells {
            let limit = Limit::new(Quantity::Cells, size.cells() as u64, 0..=self.cells as u64);
            return Err(limit.of(format!("a raster of {size} cells")).into());
        }
        ensure_room(size)?;
        Ok(size)
    }

    /// Longest file that is read: sixteen bytes per cell, which is a number in digits with its space, and 64 MiB
    /// for all else in the file.
    pub(super) fn file_bytes(self) -> u64 {
        self.cells as u64 * 16 + (64 << 20)
    }
}

/// Bytes of a cell that is read, and the most that readers take for one until all are.
const A_CELL: u64 = 5;
const MOST_OF_A_CELL: u64 = 16;

/// Rasters of fewer cells are read without asking for room.
const MANY: usize = 1 << 20;

/// Refuses a raster for which there is no memory, before any is taken.
fn ensure_room(size: Size) -> Result<(), Fault> {
    let cells = size.cells() as u64;
    if size.cells() < MANY || (is_free(A_CELL * cells) && has_addresses(&[MOST_OF_A_CELL * cells])) {
        return Ok(());
    }
    let needed = MOST_OF_A_CELL * cells;
    let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=needed - 1);
    let remedy =
        "there is not so much, or this process may not have it: free or allow it more, or cut the raster";
    Err(limit.of(format!("a raster of {size} cells")).remedy(remedy).into())
}

fn is_free(bytes: u64) -> bool {
    available().is_none_or(|free| bytes <= free)
}

/// Whether `packed` bytes can hold `expanded` bytes under a compression that makes at most `times` as many of them.
///
/// # Errors
/// [`Fault::Damaged`] with both numbers.
pub(super) fn ensure_can_hold(packed: usize, expanded: usize, times: usize) -> Result<(), Fault> {
    if expanded / times <= packed {
        return Ok(());
    }
    Err(Fault::Damaged(format!(
        "{packed} bytes cannot hold the {expanded} bytes of the cells they stand for"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_compression_can_do_is_refused() {
        assert!(ensure_can_hold(1000, 1_032_000, MAX_EXPANSION).is_ok(), "the most that Deflate does");
        assert!(ensure_can_hold(1000, 2_100_000, MAX_EXPANSION).is_err());
        assert!(ensure_can_hold(0, 2047, MAX_EXPANSION).is_ok(), "too little to matter");
    }

    #[test]
    fn a_size_is_refused_from_the_first_cell_too_many() {
        let limits = Limits { cells: 12 };
        assert_eq!(limits.size(4, 3), Ok(Size { columns: 4, rows: 3 }));
        let Err(Fault::Limit(Limit { what, asked, allowed, .. })) = limits.size(13, 1) else {
            panic!("13 cells are too many")
        };
        assert_eq!((what, asked, allowed), (Quantity::Cells, Some(13), 0..=12));
        assert!(matches!(limits.size(0, 1), Err(Fault::Damaged(_))));
    }

    #[test]
    fn the_limit_of_a_file_keeps_its_numbers_and_names_the_file() {
        let limit = Limit::new(Quantity::Cells, 9, 0..=8).of("a raster of 3 × 3 cells");
        let error = Fault::Limit(limit.clone()).of(Path::new("land.tif"));
        let message = "land.tif: a raster of 3 × 3 cells: 9 cells, at most 8 are allowed";
        assert_eq!(error.to_string(), message);
        let Error::Limit(Limit { what, asked, allowed, .. }) = error else { panic!("{message}") };
        assert_eq!((what, asked, allowed), (limit.what, limit.asked, limit.allowed));
    }
}
