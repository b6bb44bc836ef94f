//! Writing: the numbers, and their description beside them.

use super::super::{Part, Raster};
use super::sidecar::{Kind, NoData, SIDECAR, Sidecar, Word};
use weald_core::error::Error;

/// A `.raw` or `.r16` file and its description.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode_16(raster: &Raster) -> Result<Vec<Part>, Error> {
    raster.ensure_finite()?;
    let steps = Steps::of(raster.range(), raster.valid.is_some());
    let sidecar = sidecar_16(raster, &steps, raster.valid.is_some());
    Ok(vec![Part::own(steps.bytes(raster)), Part::beside(SIDECAR, sidecar.to_json())])
}

/// An `.r32` file and its description.
///
/// # Errors
/// As [`encode_16`].
pub fn encode_32(raster: &Raster) -> Result<Vec<Part>, Error> {
    raster.ensure_finite()?;
    let sidecar = sidecar_32(raster, raster.valid.is_some());
    Ok(vec![Part::own(floats(raster)), Part::beside(SIDECAR, sidecar.to_json())])
}

/// The values that whole numbers stand for. The number 0 is kept for cells without data, where there may be any; the lowest value
/// is then one step above it.
pub(super) struct Steps {
    low: f64,
    high: f64,
    first: f64,
    step: f64,
}

impl Steps {
    pub(super) fn of((low, high): (f32, f32), has_mask: bool) -> Self {
        let (low, high, first) = (f64::from(low), f64::from(high), f64::from(u8::from(has_mask)));
        Self { low, high, first, step: (high - low) / (65535.0 - first) }
    }

    fn number(&self, value: f32) -> u16 {
        let steps = if self.step == 0.0 { 0.0 } else { (f64::from(value) - self.low) / self.step };
        (self.first + steps.round()) as u16
    }

    pub(super) fn bytes(&self, raster: &Raster) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(raster.field.size().cells() * 2);
        for (index, value) in raster.field.values().iter().enumerate() {
            let number = if raster.is_valid_at(index) { self.number(*value) } else { 0 };
            bytes.extend(number.to_le_bytes());
        }
        bytes
    }
}

pub(super) fn sidecar_16(raster: &Raster, steps: &Steps, has_mask: bool) -> Sidecar {
    Sidecar {
        value_of_0: Some(steps.low - steps.first * steps.step),
        value_of_65535: Some(steps.high),
        no_data: has_mask.then_some(NoData::Number(0.0)),
        ..Sidecar::of(raster, Kind::Uint16)
    }
}

pub(super) fn sidecar_32(raster: &Raster, has_mask: bool) -> Sidecar {
    Sidecar { no_data: has_mask.then_some(NoData::Word(Word::NaN)), ..Sidecar::of(raster, Kind::Float32) }
}

/// The values themselves, NaN in cells without data.
pub(super) fn floats(raster: &Raster) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(raster.field.size().cells() * 4);
    for (index, value) in raster.field.values().iter().enumerate() {
        let value = if raster.is_valid_at(index) { *value } else { f32::NAN };
        bytes.extend(value.to_le_bytes());
    }
    bytes
}
