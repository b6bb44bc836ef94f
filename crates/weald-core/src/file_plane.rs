//! A plane of numbers in a file, for grids that are larger than memory.

use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::Error;
use crate::files::File;
use crate::grid::Size;
use crate::plane::{Plane, Window};

/// Bytes of a value.
pub const VALUE: u64 = 4;

/// Bytes that are worth reading or writing at a time.
pub const AT_ONCE: usize = 1 << 20;

/// Values in a file of its own, row by row, which no other program reads.
#[derive(Debug)]
pub struct FilePlane {
    name: String,
    size: Size,
    file: Mutex<File>,
}

impl FilePlane {
    /// A plane of zeros in an empty file; `name` is for messages. Room on the disk is taken as values are written.
    ///
    /// # Errors
    /// [`Error::Run`] where the file cannot be made so long.
    pub fn new(name: impl Into<String>, file: File, size: Size) -> Result<Self, Error> {
        let plane = Self { name: name.into(), size, file: Mutex::new(file) };
        let bytes = VALUE * size.columns as u64 * size.rows as u64;
        plane.locked().set_len(bytes).map_err(|cause| plane.failed("made", &cause))?;
        Ok(plane)
    }

    /// The values of whole rows.
    ///
    /// # Errors
    /// As [`Plane::read`].
    pub fn rows(&self, rows: Range<usize>) -> Result<Vec<f32>, Error> {
        self.read(&Window { columns: 0..self.size.columns, rows })
    }

    /// Replaces the values of whole rows.
    ///
    /// # Errors
    /// As [`Plane::write`].
    pub fn set_rows(&mut self, rows: Range<usize>, values: &[f32]) -> Result<(), Error> {
        self.write(&Window { columns: 0..self.size.columns, rows }, values)
    }

    /// Rows that are worth reading at a time, in runs from north to south.
    pub fn runs_of_rows(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let (rows, run) = (self.size.rows, (AT_ONCE / (VALUE as usize * self.size.columns)).max(1));
        (0..rows).step_by(run).map(move |first| first..(first + run).min(rows))
    }

    fn locked(&self) -> MutexGuard<'_, File> {
        // What a panic has left in a file is not read again.
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs of values that lie one after the other, each with its place in the file.
    fn runs(&self, window: &Window) -> impl Iterator<Item = (u64, usize)> + use<> {
        let (columns, count) = (self.size.columns, window.columns.len());
        let whole_rows = if count == columns { (AT_ONCE / (VALUE as usize * columns)).max(1) } else { 1 };
        let (west, rows) = (window.columns.start, window.rows.clone());
        rows.clone().step_by(whole_rows).map(move |y| {
            let together = whole_rows.min(rows.end - y);
            (VALUE * (y as u64 * columns as u64 + west as u64), together * count)
        })
    }

    fn failed(&self, what: &str, cause: &std::io::Error) -> Error {
        let remedy = match cause.kind() {
            ErrorKind::StorageFull => "; make room in the scratch folder, or choose one on a larger disk",
            _ => "",
        };
        Error::Run(format!("the plane of `{}` on disk cannot be {what}: {cause}{remedy}", self.name))
    }
}

impl Plane<f32> for FilePlane {
    fn size(&self) -> Size {
        self.size
    }

    fn read(&self, window: &Window) -> Result<Vec<f32>, Error> {
        let mut values = Vec::with_capacity(window.size().cells());
        let (mut file, mut bytes) = (self.locked(), Vec::new());
        for (place, count) in self.runs(window) {
            bytes.resize(count * VALUE as usize, 0);
            let read = file.seek(SeekFrom::Start(place)).and_then(|_| file.read_exact(&mut bytes));
            read.map_err(|cause| self.failed("read", &cause))?;
            let (numbers, _) = bytes.as_chunks();
            values.extend(numbers.iter().map(|&number| f32::from_le_bytes(number)));
        }
        Ok(values)
    }

    fn write(&mut self, window: &Window, values: &[f32]) -> Result<(), Error> {
        let (mut file, mut bytes, mut rest) = (self.locked(), Vec::new(), values);
        for (place, count) in self.runs(window) {
            let (run, after) = rest.split_at(count);
            rest = after;
            bytes.clear();
            bytes.extend(run.iter().flat_map(|value| value.to_le_bytes()));
            let written = file.seek(SeekFrom::Start(place)).and_then(|_| file.write_all(&bytes));
            written.map_err(|cause| self.failed("written", &cause))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files;

    #[test]
    fn values_come_back_from_any_window() {
        let path = std::env::temp_dir().join(format!("weald-plane-{}", files::process_id()));
        let file =
            File::options().read(true).write(true).create(true).truncate(true).open(&path).expect("a file");
        files::remove_file(&path).expect("it needs no name");
        let size = Size { columns: 700, rows: 900 };
        let mut plane = FilePlane::new("test", file, size).expect("room");
        let value = |x: usize, y: usize| (y * 1000 + x) as f32 - 0.5;
        let over = |window: &Window| {
            let columns = window.columns.clone();
            window
                .rows
                .clone()
                .flat_map(move |y| columns.clone().map(move |x| value(x, y)))
                .collect::<Vec<_>>()
        };
        let whole = Window::whole(size);
        plane.write(&whole, &over(&whole)).expect("room");
        for window in
            [whole, Window { columns: 3..640, rows: 5..800 }, Window { columns: 0..700, rows: 899..900 }]
        {
            assert_eq!(plane.read(&window).expect("there"), over(&window));
        }
        let part = Window { columns: 10..12, rows: 20..22 };
        plane.write(&part, &[1.0, 2.0, 3.0, 4.0]).expect("room");
        assert_eq!(plane.rows(21..22).expect("there")[9..13], [value(9, 21), 3.0, 4.0, value(12, 21)]);
        assert_eq!(plane.runs_of_rows().map(|rows| rows.len()).sum::<usize>(), 900);
    }
}
