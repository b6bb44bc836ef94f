//! `NetCDF` in its classic format (Unidata, "The `NetCDF` Classic Format Specification"): CDF-1, CDF-2 with
//! offsets of 64 bits, CDF-5 with sizes of 64 bits.
//!
//! Written is CDF-1, or CDF-2 where an offset needs it, with the attributes of `cf`; the preset `landlab` names
//! the variables and orders the rows as landlab does. Read is any of the three, as far as `cf` reads its arrays. `NetCDF`-4 is
//! another format (HDF5) and is not read: `nccopy -k classic` or `gdal_translate -co FORMAT=NC` turns it.
//!
//! The header is parsed here, so that every size is checked against the limits and the file before anything is
//! allocated.

mod cursor;
mod header;
mod kind;
mod read;
mod write;

pub use read::decode;

use super::cf::{Dataset, Names, OMITTED_CRS, Sheet};
use super::{Capabilities, Decode, Encode, Format, Preset, Raster};
use weald_core::error::Error;

const CAPABILITIES: Capabilities = Capabilities { omits: &[OMITTED_CRS], ..Capabilities::ALL };

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "NetCDF",
    extensions: &["nc"],
    decode: Some(Decode::File(decode)),
    encode: Some(Encode::File(encode)),
    holds: CAPABILITIES,
    presets: &[Preset {
        name: "landlab",
        summary: "variables have landlab's names, such as topographic__elevation, and rows begin in the south",
        encode: Encode::File(encode_for_landlab),
        holds: CAPABILITIES,
    }],
};

/// The bytes of a file.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    encode_sheet(&Sheet::of(raster, Names::Weald))
}

fn encode_for_landlab(raster: &Raster) -> Result<Vec<u8>, Error> {
    encode_sheet(&Sheet::of(raster, Names::Landlab))
}

/// The bytes of a file of several layers.
///
/// # Errors
/// As [`encode`].
pub fn encode_sheet(sheet: &Sheet<'_>) -> Result<Vec<u8>, Error> {
    Ok(write::bytes(&Dataset::of(sheet)?))
}
