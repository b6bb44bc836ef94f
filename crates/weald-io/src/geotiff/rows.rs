//! Rows of a file that is not read as a whole.

use std::ops::Range;
use std::path::Path;

use super::super::format::RowsOfFile;
use super::super::{Fault, Raster};
use super::chunks::OnDisk;
use super::directory::Directory;
use super::read::Coding;
use weald_core::error::Error;
use weald_core::grid::Size;

/// A file of which the directories are known, and nothing else.
#[derive(Debug)]
struct TiffRows {
    head: Vec<u8>,
    file: OnDisk,
    size: Size,
    rows_at_once: usize,
    bytes_at_once: u64,
}

/// Opens a file to read rows of it.
///
/// # Errors
/// As [`decode`](super::decode), but for what chunks alone tell.
pub(super) fn open(path: &Path) -> Result<Box<dyn RowsOfFile>, Fault> {
    let file = OnDisk::open(path)?;
    let head = file.head()?;
    let coding = coding(&head, &file)?;
    let (size, rows_at_once, bytes_at_once) = (coding.size(), coding.rows_at_once(), coding.bytes_at_once());
    Ok(Box::new(TiffRows { head, file, size, rows_at_once, bytes_at_once }))
}

fn coding<'a>(head: &'a [u8], file: &'a OnDisk) -> Result<Coding<'a>, Fault> {
    Coding::of(Directory::parse(head)?, file, &|columns, rows| match Size::on_disk(columns, rows) {
        Ok(size) => Ok(size),
        Err(Error::Limit(limit)) => Err(limit.into()),
        Err(other) => Err(Fault::damaged(other.to_string())),
    })
}

impl RowsOfFile for TiffRows {
    fn size(&self) -> Size {
        self.size
    }

    fn rows_at_once(&self) -> usize {
        self.rows_at_once
    }

    fn bytes_at_once(&self) -> u64 {
        self.bytes_at_once
    }

    fn rows(&self, rows: Range<usize>) -> Result<Raster, Fault> {
        coding(&self.head, &self.file)?.raster(rows)
    }
}
