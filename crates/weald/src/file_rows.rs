//! Rows of a raster file that is never in memory as a whole.

use std::ops::Range;
use std::path::Path;

use weald_core::error::{Error, Limit, Quantity};
use weald_io::RowsOfFile;

/// Some rows in runs that are worth reading at a time.
pub(crate) fn runs_of_rows(
    file: &dyn RowsOfFile,
    rows: Range<usize>,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let (high, mut first) = (file.rows_at_once(), rows.start);
    std::iter::from_fn(move || {
        let run = first..((first / high + 1) * high).min(rows.end);
        first = run.end;
        (!run.is_empty()).then_some(run)
    })
}

/// Whether the memory holds the rows that are read at a time.
///
/// # Errors
/// [`Error::Limit`] where it does not.
pub(crate) fn ensure_memory(path: &Path, file: &dyn RowsOfFile, memory: u64) -> Result<(), Error> {
    let needed = file.bytes_at_once();
    if needed <= memory {
        return Ok(());
    }
    let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=memory);
    let rows = format!("{}: {} rows, which are packed together", path.display(), file.rows_at_once());
    let remedy = "allow more memory, or write it in tiles: gdal_translate -co TILED=YES";
    Err(limit.of(rows).remedy(remedy).into())
}
