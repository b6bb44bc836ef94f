//! Reading: the description first, then the length of the file, then the numbers.

use super::super::parts::{PartName, Parts};
use super::super::{Fault, Limits, Provenance, Raster};
use super::sidecar::{ByteOrder, Kind, NoData, SIDECAR, Sidecar};
use weald_core::grid::Size;

/// What ends the name of a description that others write.
const ENVI: &str = ".hdr";

/// Longest description that is read, in bytes.
const SIDECAR_BYTES: u64 = 1 << 20;

/// Reads a `.raw` or `.r16` file: what its description says, or a square of 16-bit whole numbers.
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode_16(parts: &dyn Parts, limits: Limits) -> Result<Raster, Fault> {
    decode(parts, limits, Kind::Uint16)
}

/// Reads an `.r32` file: what its description says, or a square of 32-bit floats.
///
/// # Errors
/// As [`decode_16`].
pub fn decode_32(parts: &dyn Parts, limits: Limits) -> Result<Raster, Fault> {
    decode(parts, limits, Kind::Float32)
}

fn decode(parts: &dyn Parts, limits: Limits, kind: Kind) -> Result<Raster, Fault> {
    let described = parts.read(&PartName::Beside(SIDECAR.to_owned()), SIDECAR_BYTES)?;
    let bytes = parts
        .read(&PartName::Own, limits.file_bytes())?
        .ok_or_else(|| Fault::damaged("cannot be read: there is no such file"))?;
    if let Some(json) = described {
        return numbers(&bytes, &Sidecar::parse(&json)?, limits);
    }
    if parts.read(&PartName::Sibling(ENVI.to_owned()), SIDECAR_BYTES)?.is_some() {
        return Err(Fault::damaged(format!(
            "beside it lies a description of ENVI (.hdr), which is not read, and no {SIDECAR}: gdal_translate it to .tif"
        )));
    }
    let side = side(bytes.len(), kind)?;
    let mut raster = numbers(&bytes, &Sidecar::plain(side, side, kind), limits)?;
    raster.notes.push(format!(
        "there is no {SIDECAR} beside it: read as {side} × {side} little-endian {} numbers as they are, rows from \
         north to south",
        kind.name()
    ));
    Ok(raster)
}

/// Side of the square that a file without a description must be.
fn side(bytes: usize, kind: Kind) -> Result<usize, Fault> {
    let side = (bytes / kind.bytes()).isqrt();
    if side * side * kind.bytes() == bytes {
        return Ok(side);
    }
    Err(Fault::damaged(format!(
        "{bytes} bytes are no square of {} numbers, and there is no description beside it; write one, of the \
         file's name and {SIDECAR}: {{\"columns\": …, \"rows\": …, \"type\": \"{}\"}}",
        kind.name(),
        kind.name()
    )))
}

fn numbers(bytes: &[u8], sidecar: &Sidecar, limits: Limits) -> Result<Raster, Fault> {
    let size = limits.size(sidecar.columns, sidecar.rows)?;
    let needed = size.cells() * sidecar.kind.bytes();
    if bytes.len() != needed {
        return Err(Fault::damaged(format!(
            "{size} numbers of {} need {needed} bytes, but the file has {}",
            sidecar.kind.name(),
            bytes.len()
        )));
    }
    let raster = match sidecar.kind {
        Kind::Uint16 => whole(bytes, sidecar, size),
        Kind::Float32 => floats(bytes, sidecar, size),
    }?;
    Ok(Raster {
        cell: sidecar.cell_metres,
        georeference: sidecar.place.clone(),
        provenance: Provenance::from_items(|key| sidecar.provenance.get(key).cloned()),
        ..raster
    })
}

fn whole(bytes: &[u8], sidecar: &Sidecar, size: Size) -> Result<Raster, Fault> {
    let (step, low) = sidecar.scale();
    let join = match sidecar.byte_order {
        ByteOrder::Little => u16::from_le_bytes,
        ByteOrder::Big => u16::from_be_bytes,
    };
    let numbers = || bytes.chunks_exact(2).map(|two| f64::from(join([two[0], two[1]])));
    let is_valid = |number: f64| !matches!(sidecar.no_data, Some(NoData::Number(none)) if none == number);
    let value = |number: f64| if is_valid(number) { (low + step * number) as f32 } else { 0.0 };
    let values = numbers().map(value).collect();
    Raster::from_file(size, values, numbers().map(is_valid).collect(), sidecar.kind.name())
}

fn floats(bytes: &[u8], sidecar: &Sidecar, size: Size) -> Result<Raster, Fault> {
    let join = match sidecar.byte_order {
        ByteOrder::Little => f32::from_le_bytes,
        ByteOrder::Big => f32::from_be_bytes,
    };
    let numbers = || bytes.chunks_exact(4).map(|four| join([four[0], four[1], four[2], four[3]]));
    let is_valid = |number: f32| match sidecar.no_data {
        None => true,
        Some(NoData::Number(none)) => number != none as f32,
        Some(NoData::Word(_)) => !number.is_nan(),
    };
    let values = numbers().map(|number| if is_valid(number) { number } else { 0.0 }).collect();
    Raster::from_file(size, values, numbers().map(is_valid).collect(), sidecar.kind.name())
}
