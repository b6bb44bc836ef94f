//! ESRI ASCII grid (`.asc`): a header of a few words and numbers, then rows of numbers from north to south.
//!
//! Numbers are written with as many digits as bring the same bits back. The CRS stands beside the grid in a
//! `.prj` file, as ESRI's well-known text, for longitude and latitude and the UTM zones of WGS 84, NAD83 and ETRS89. The corner is the
//! south-western one in the file; where that of the north-west was finer than a `f64` of the other can tell,
//! it comes back within its last digit.

mod crs;
mod header;
mod read;
mod write;

pub use read::decode;
pub use write::encode;

use super::{Capabilities, Decode, Encode, Format, Metadata};

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "ESRI ASCII grid",
    extensions: &["asc"],
    decode: Some(Decode::Parts(decode)),
    encode: Some(Encode::Parts(encode)),
    holds: Capabilities { omits: &[crs::OMITTED, Metadata::Provenance], ..Capabilities::ALL },
    presets: &[],
};
