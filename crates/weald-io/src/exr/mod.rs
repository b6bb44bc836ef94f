//! OpenEXR (`.exr`, file format version 2): one channel `Y` of 32-bit floats in metres, ZIP in blocks of
//! 16 rows, no-data as NaN. Place, cell and provenance stand in attributes of their own.
//!
//! Read are flat single-part files of scan lines or tiles, of `half`, `float` or `uint`, without compression
//! or with RLE, ZIPS, ZIP and PIZ. A file of one channel is read whatever its name; of several, `Y`, or `R`
//! where `G` and `B` hold the same bits. Of a mipmap or ripmap the finest level is read.
//!
//! Sizes in the header are checked against limits, and every block against the bytes that stand for it, before
//! anything is allocated; only then do bytes go to a decompressor, which fills a buffer of known length.
//!
//! Source: Technical Introduction to OpenEXR and OpenEXR File Layout, Academy Software Foundation.

mod attributes;
mod compression;
mod header;
mod huffman;
mod piz;
mod read;
mod wavelet;
mod write;

pub use read::decode;
pub use write::encode;
pub use write::encode_for_godot;

use super::{Capabilities, Decode, Encode, Format, Metadata, Preset, Values};

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "OpenEXR",
    extensions: &["exr"],
    decode: Some(Decode::File(decode)),
    encode: Some(Encode::File(encode)),
    holds: Capabilities::ALL,
    presets: &[
        Preset {
            name: "blender",
            summary: "channels R, G and B with the same floats, since Blender shows others as black; no NaN",
            encode: Encode::File(write::encode_for_blender),
            holds: Capabilities { omits: &[Metadata::NoData], ..Capabilities::ALL },
        },
        Preset {
            name: "terrain3d",
            summary: "one channel R of floats, as Godot loads for Terrain3D; no NaN",
            encode: Encode::File(encode_for_godot),
            holds: Capabilities { omits: &[Metadata::NoData], ..Capabilities::ALL },
        },
        Preset {
            name: "hterrain",
            summary: "one channel R of half floats, as Zylann's HTerrain for Godot loads; no NaN. It crops to \
                      squares of 513, 1025, 2049 or 4097 cells",
            encode: Encode::File(write::encode_for_hterrain),
            holds: Capabilities { values: Values::Float16, omits: &[Metadata::NoData] },
        },
    ],
};
