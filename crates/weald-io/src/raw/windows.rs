//! Writing bare numbers whose values are not in memory: some rows at a time, to the bytes that the whole gives.

use std::io::{BufWriter, Write};

use super::super::format::WindowedRaster;
use super::super::{Part, Raster};
use super::sidecar::{SIDECAR, Sidecar};
use super::write::{Steps, floats, sidecar_16, sidecar_32};
use weald_core::error::Error;
use weald_core::files::File;
use weald_core::grid::{Field, Mask, Size};
use weald_core::plane::Window;

/// Rows at a time: those that ranks hand on together.
const ROWS: usize = 256;

/// 16-bit whole numbers.
pub(super) fn write_16(raster: &WindowedRaster<'_, '_>, file: &mut File) -> Result<Vec<Part>, Error> {
    let steps = Steps::of(raster.range, raster.valid.is_some());
    write(raster, file, |rows| steps.bytes(rows))?;
    Ok(beside(raster, sidecar_16(raster.head, &steps, raster.valid.is_some())))
}

/// 32-bit floats.
pub(super) fn write_32(raster: &WindowedRaster<'_, '_>, file: &mut File) -> Result<Vec<Part>, Error> {
    write(raster, file, floats)?;
    Ok(beside(raster, sidecar_32(raster.head, raster.valid.is_some())))
}

fn beside(raster: &WindowedRaster<'_, '_>, sidecar: Sidecar) -> Vec<Part> {
    let Size { columns, rows } = raster.values.size();
    vec![Part::beside(SIDECAR, Sidecar { columns, rows, ..sidecar }.to_json())]
}

fn write(
    raster: &WindowedRaster<'_, '_>,
    file: &mut File,
    bytes: impl Fn(&Raster) -> Vec<u8>,
) -> Result<(), Error> {
    let size = raster.values.size();
    let failed = |cause: std::io::Error| Error::Run(format!("the file cannot be written: {cause}"));
    let mut out = BufWriter::new(file);
    for first in (0..size.rows).step_by(ROWS) {
        let window = Window { columns: 0..size.columns, rows: first..(first + ROWS).min(size.rows) };
        let flags = raster.valid.map(|valid| valid.read(&window)).transpose()?;
        let flags = flags.map(|flags| flags.into_iter().map(|flag| flag > 0.0).collect());
        let rows = Raster {
            valid: flags.and_then(|flags| Mask::new(window.size(), flags)),
            ..Raster::from(Field::from_values(window.size(), raster.values.read(&window)?))
        };
        rows.ensure_finite()?;
        out.write_all(&bytes(&rows)).map_err(failed)?;
    }
    out.flush().map_err(failed)
}
