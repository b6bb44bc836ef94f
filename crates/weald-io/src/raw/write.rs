//! Writing: numbers in little-endian order, and their description.

use super::super::{Part, Raster};
use super::sidecar::{Kind, NoData, SIDECAR, Sidecar, Word};
use weald_core::error::Error;

/// A `.raw` or `.r16` file and its description.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode_16(raster: &Raster) -> Result<Vec<Part>, Error> {
    raster.ensure_finite()?;
    let (low, high) = raster.range();
    let (low, high) = (f64::from(low), f64::from(high));
    // The number 0 is kept for cells without data; the lowest value is then one step above it.
    let first = f64::from(u8::from(raster.valid.is_some()));
    let step = (high - low) / (65535.0 - first);
    let number = |value: f32| {
        let steps = if step == 0.0 { 0.0 } else { (f64::from(value) - low) / step };
        (first + steps.round()) as u16
    };
    let mut bytes = Vec::with_capacity(raster.field.size().cells() * 2);
    for (index, value) in raster.field.values().iter().enumerate() {
        bytes.extend(if raster.is_valid_at(index) { number(*value) } else { 0 }.to_le_bytes());
    }
    let sidecar = Sidecar {
        value_of_0: Some(low - first * step),
        value_of_65535: Some(high),
        no_data: raster.valid.as_ref().map(|_| NoData::Number(0.0)),
        ..Sidecar::of(raster, Kind::Uint16)
    };
    Ok(vec![Part::own(bytes), Part::beside(SIDECAR, sidecar.to_json())])
}

/// An `.r32` file and its description.
///
/// # Errors
/// As [`encode_16`].
pub fn encode_32(raster: &Raster) -> Result<Vec<Part>, Error> {
    raster.ensure_finite()?;
    let mut bytes = Vec::with_capacity(raster.field.size().cells() * 4);
    for (index, value) in raster.field.values().iter().enumerate() {
        let value = if raster.is_valid_at(index) { *value } else { f32::NAN };
        bytes.extend(value.to_le_bytes());
    }
    let no_data = raster.valid.as_ref().map(|_| NoData::Word(Word::NaN));
    let sidecar = Sidecar { no_data, ..Sidecar::of(raster, Kind::Float32) };
    Ok(vec![Part::own(bytes), Part::beside(SIDECAR, sidecar.to_json())])
}
