//! A Zarr array of version 2 whose one chunk is the input, packed as a compressor says.
//!
//! The chunk is as small as still has every part: Blosc cuts blocks of 128 numbers and more into streams.

use weald::io::{InMemory, Limits, Part, zarr};

const LIMITS: Limits = Limits { cells: 1 << 16 };
const SIDE: usize = 16;

/// Any chunk is a raster of finite numbers or a fault.
pub fn unpack(compressor: &str, bytes: &[u8]) {
    let array = format!(
        "{{\"zarr_format\": 2, \"shape\": [{SIDE}, {SIDE}], \"chunks\": [{SIDE}, {SIDE}], \"dtype\": \"<f4\", \"compressor\": \
         {compressor}, \"fill_value\": null, \"order\": \"C\", \"filters\": null}}"
    );
    let group = "{\"zarr_format\": 2}".as_bytes().to_vec();
    let parts = vec![
        Part::inside(".zgroup", group),
        Part::inside("height/.zarray", array.into_bytes()),
        Part::inside("height/0.0", bytes.to_vec()),
    ];
    let Ok(raster) = zarr::decode(&InMemory::of("a.zarr", parts), LIMITS) else { return };
    assert_eq!(raster.field.size().cells(), SIDE * SIDE);
}
