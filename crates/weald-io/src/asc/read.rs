//! Reading: the header, then as many numbers as it promises.

use super::super::geokeys::metres_per_unit;
use super::super::parts::{PartName, Parts};
use super::super::unit::Measure;
use super::super::{Fault, Limits, Raster};
use super::crs::{self, CRS_FILE, Said};
use super::header::Header;
use weald_core::domain::Georeference;

/// Longest `.prj` that is read, in bytes.
const CRS_BYTES: u64 = 1 << 16;

/// Sides of a cell may differ by this share and still be called square: what decimal digits lose.
const SQUARE: f64 = 1e-9;

/// Reads a grid and the CRS beside it.
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode(parts: &dyn Parts, limits: Limits) -> Result<Raster, Fault> {
    let bytes = parts
        .read(&PartName::Own, limits.file_bytes())?
        .ok_or_else(|| Fault::damaged("cannot be read: there is no such file"))?;
    let text = std::str::from_utf8(&bytes).map_err(|cause| {
        Fault::damaged(format!("byte {} is no text; an ESRI ASCII grid is plain text", cause.valid_up_to()))
    })?;
    let mut tokens = text.split_ascii_whitespace().peekable();
    let header = Header::parse(&mut tokens, limits)?;
    let crs = parts.read(&PartName::Sibling(CRS_FILE.to_owned()), CRS_BYTES)?;
    let crs = crs.map(|text| crs::read(&String::from_utf8_lossy(&text))).transpose()?;
    let measure = Measure::new(1.0, 0.0, crs.as_ref().and_then(|crs| crs.unit.as_deref()));
    let mut raster = values(&header, &measure, bytes.len(), &mut tokens)?;
    if !bytes.ends_with(b"\n") {
        let note = "the file does not end with the end of a line: its last number may have been cut off";
        raster.notes.push(note.to_owned());
    }
    placed(raster, &header, crs)
}

fn values<'a>(
    header: &Header,
    measure: &Measure,
    bytes: usize,
    tokens: &mut impl Iterator<Item = &'a str>,
) -> Result<Raster, Fault> {
    let size = header.size;
    // A value takes a digit and a space, the last one a digit.
    if bytes < 2 * size.cells() - 1 {
        return Err(Fault::damaged(format!(
            "{bytes} bytes cannot hold {size} numbers; the file is truncated"
        )));
    }
    let (mut values, mut valid) = (Vec::with_capacity(size.cells()), Vec::with_capacity(size.cells()));
    for index in 0..size.cells() {
        let place = || format!("column {}, row {}", index % size.columns, index / size.columns);
        let token = tokens
            .next()
            .ok_or_else(|| Fault::damaged(format!("the file ends before {} of {size} cells", place())))?;
        let value: f32 =
            token.parse().map_err(|_| Fault::damaged(format!("{} holds {token:?}, no number", place())))?;
        let is_valid = !value.is_nan() && header.no_data != value;
        valid.push(is_valid);
        values.push(if is_valid { measure.value(f64::from(value)) } else { 0.0 });
    }
    match tokens.next() {
        None => Ok(Raster::from_file(size, values, valid, "text")?.measured(measure)),
        Some(token) => Err(Fault::damaged(format!(
            "{token:?} follows the last of {size} numbers; ncols and nrows are not those of the rows"
        ))),
    }
}

/// The raster at its place. A grid at 0, 0 without a CRS has none.
fn placed(raster: Raster, header: &Header, crs: Option<Said>) -> Result<Raster, Fault> {
    let pixel = header.pixel;
    // Cells below a centimetre may be degrees, which their place tells.
    let is_placed = crs.is_some() || header.corner != [0.0; 2] || pixel[0] < 0.01;
    let Said { epsg, keys, .. } = crs.unwrap_or_default();
    let metres = metres_per_unit(keys.as_ref())?;
    let origin = [header.corner[0], header.corner[1] + header.size.rows as f64 * pixel[1]];
    let place = Georeference { epsg, origin, pixel, keys };
    let is_square = (pixel[0] - pixel[1]).abs() <= SQUARE * pixel[0];
    let cell = (is_square && !place.is_geographic()).then_some(pixel[0] * metres);
    Ok(Raster { cell, georeference: is_placed.then_some(place), ..raster })
}
