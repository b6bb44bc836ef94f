//! Bare numbers (`.raw`, `.r16`, `.r32`) with their description beside them in `NAME.json`, as in
//! `land.r16.json`: `columns`, `rows`, `type` (`uint16` or `float32`), `byte_order` (`little`, the default, or
//! `big`), `value_of_0` and `value_of_65535` for whole numbers, `no_data` (a number or `"NaN"`),
//! `cell_metres`, `place` (EPSG code, north-western corner, cell in CRS units) and `provenance`. All but the
//! first three may be left out.
//!
//! `.raw` and `.r16` are 16-bit whole numbers, little-endian, scaled to the range of the layer; where cells
//! have no data these hold 0 and the lowest value is 1. `.r32` are the 32-bit floats themselves, no-data as
//! NaN. Rows go from north to south. A square file without a description is read as its raw numbers.

mod read;
mod sidecar;

pub use read::{decode_16, decode_32};

use self::sidecar::{Kind, NoData, SIDECAR, Sidecar, Word};
use super::{Capabilities, Decode, Encode, Format, Part, Raster, Values};
use weald_core::error::Error;

/// The entry of 16-bit files in the registry of formats.
pub(super) const FORMAT_16: Format = Format {
    name: "16-bit raw",
    extensions: &["raw", "r16"],
    decode: Some(Decode::Parts(decode_16)),
    encode: Some(Encode::Parts(encode_16)),
    holds: Capabilities { values: Values::Steps16, ..Capabilities::ALL },
    presets: &[],
};

/// The entry of 32-bit files in the registry of formats.
pub(super) const FORMAT_32: Format = Format {
    name: "32-bit raw",
    extensions: &["r32"],
    decode: Some(Decode::Parts(decode_32)),
    encode: Some(Encode::Parts(encode_32)),
    holds: Capabilities::ALL,
    presets: &[],
};

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
