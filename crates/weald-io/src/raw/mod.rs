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
mod windows;
mod write;

pub use read::{decode_16, decode_32};
pub use write::{encode_16, encode_32};

use super::{Capabilities, Decode, Encode, Format, Values};

/// The entry of 16-bit files in the registry of formats.
pub(super) const FORMAT_16: Format = Format {
    name: "16-bit raw",
    extensions: &["raw", "r16"],
    decode: Some(Decode::Parts(decode_16)),
    encode: Some(Encode::Windows { parts: encode_16, write: windows::write_16 }),
    holds: Capabilities { values: Values::Steps16, ..Capabilities::ALL },
    presets: &[],
};

/// The entry of 32-bit files in the registry of formats.
pub(super) const FORMAT_32: Format = Format {
    name: "32-bit raw",
    extensions: &["r32"],
    decode: Some(Decode::Parts(decode_32)),
    encode: Some(Encode::Windows { parts: encode_32, write: windows::write_32 }),
    holds: Capabilities::ALL,
    presets: &[],
};
