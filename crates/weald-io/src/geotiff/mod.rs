//! GeoTIFF (OGC 19-008r4 on TIFF 6.0 and `BigTIFF`), one band.
//!
//! Read: strips and tiles; no compression, LZW, Deflate, `PackBits`, Zstandard; predictors 1, 2 and 3; unsigned integers of
//! 1 to 32 and of 64 bits, signed ones of 8, 16, 32 and 64, floats of 16, 32 and 64; both byte orders; rows from either
//! side. Written: `float32`, or whole numbers where the values are classes, in tiles of 256 × 256, Deflate, predictor 3 or 2,
//! with smaller images by the preset `cog`. No-data is GDAL's tag 42113 and NaN; scale, offset,
//! unit and provenance are its tag 42112.
//!
//! Rows are also read alone, from a file of which no more is read than the chunks that hold them.
//!
//! The tag directory is parsed here rather than by a general TIFF library, so that every size is checked
//! against the limits and the file before anything is allocated, and tiles decode on all cores.

mod chunks;
mod compression;
mod directory;
mod head;
mod keys;
mod layout;
mod legend;
mod metadata;
mod overviews;
mod read;
mod rows;
mod sample;
mod tiles;
mod windows;
mod write;

pub use read::decode;
pub use write::encode;

use super::{Capabilities, Decode, Encode, Format, Preset};

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "GeoTIFF",
    extensions: &["tif", "tiff"],
    decode: Some(Decode::Rows { whole: decode, open: rows::open }),
    encode: Some(Encode::Windows { parts: write::parts, write: windows::plain }),
    holds: Capabilities::ALL,
    presets: &[Preset {
        name: "cog",
        summary: "cloud-optimized, with smaller images of it, which programs show from afar",
        encode: Encode::Windows { parts: write::cloud_optimized, write: windows::cloud_optimized },
        holds: Capabilities::ALL,
    }],
};
