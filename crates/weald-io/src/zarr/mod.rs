//! Zarr (core specification 3.0, storage specification 2): a folder with descriptions in JSON and chunks of numbers.
//!
//! Written is a group of version 3 with the attributes of `cf` and metadata consolidated, so that xarray opens it
//! as a dataset; layers in chunks of 256 × 256, little-endian, gzip, each a file of its own or, by the preset `sharded`, up
//! to 64 of a row in one file; chunks without any data are left out, as NaN
//! fills them. Rows of chunks share no file, so that each can have a writer of its own. Read is a group or a single array of either version, in regular chunks with the codecs `bytes`,
//! `gzip`, `zlib`, `zstd`, `lz4`, `blosc` and `crc32c`, each in a file of its own or many in a shard; other codecs are
//! named in the error.
//!
//! Shapes and chunks are checked against the limits before anything is allocated, and a chunk may not unpack to
//! more than its shape says.

mod attributes;
mod blosc;
mod codec;
mod metadata;
mod read;
mod shard;
mod version2;
mod write;

pub use read::decode;

use super::cf::{Dataset, Names, OMITTED_CRS, Sheet};
use super::{ByStrips, Capabilities, Decode, Encode, Format, Part, Preset, Raster, StripPlace};
use weald_core::error::Error;
use weald_core::grid::Size;
use write::{CHUNK, Files};

const CAPABILITIES: Capabilities = Capabilities { omits: &[OMITTED_CRS], ..Capabilities::ALL };

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "Zarr",
    extensions: &["zarr"],
    decode: Some(Decode::Parts(decode)),
    encode: Some(Encode::Strips {
        parts: encode,
        by_strips: ByStrips {
            rows: CHUNK,
            descriptions: |raster, size| described(raster, size, Files::OfChunks),
            strip: |raster, place| encode_strip(raster, place, Files::OfChunks),
        },
    }),
    holds: CAPABILITIES,
    presets: &[
        Preset {
            name: "landlab",
            summary: "arrays have landlab's names, such as topographic__elevation, and rows begin in the south",
            encode: Encode::Parts(encode_for_landlab),
            holds: CAPABILITIES,
        },
        Preset {
            name: "sharded",
            summary: "up to 64 chunks share a file, a shard, so that large grids have fewer files",
            encode: Encode::Strips {
                parts: encode_in_shards,
                by_strips: ByStrips {
                    rows: CHUNK,
                    descriptions: |raster, size| described(raster, size, IN_SHARDS),
                    strip: |raster, place| encode_strip(raster, place, IN_SHARDS),
                },
            },
            holds: CAPABILITIES,
        },
    ],
};

/// The preset `sharded`.
const IN_SHARDS: Files = Files::OfShards(64);

/// The files of a group.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<Part>, Error> {
    encode_sheet(&Sheet::of(raster, Names::Weald))
}

fn encode_in_shards(raster: &Raster) -> Result<Vec<Part>, Error> {
    Ok(write::parts(&Dataset::of(&Sheet::of(raster, Names::Weald))?, IN_SHARDS))
}

/// The files without values of a raster of so many columns and rows.
fn described(raster: &Raster, size: Size, files: Files) -> Result<Vec<Part>, Error> {
    Ok(write::descriptions(&Dataset::on(&Sheet::of(raster, Names::Weald), size)?, files))
}

/// The files of some rows of a raster.
fn encode_strip(strip: &Raster, place: StripPlace, files: Files) -> Result<Vec<Part>, Error> {
    let dataset = Dataset::on(&Sheet::of(strip, Names::Weald), place.whole)?;
    Ok(write::layers(&dataset, place.first, files))
}

fn encode_for_landlab(raster: &Raster) -> Result<Vec<Part>, Error> {
    encode_sheet(&Sheet::of(raster, Names::Landlab))
}

/// The files of a group of several layers.
///
/// # Errors
/// As [`encode`].
pub fn encode_sheet(sheet: &Sheet<'_>) -> Result<Vec<Part>, Error> {
    Ok(write::parts(&Dataset::of(sheet)?, Files::OfChunks))
}
