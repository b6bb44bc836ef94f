//! Any bytes are a raster or a fault; what was read is written and read again the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{Limits, netcdf};

const LIMITS: Limits = Limits { cells: 1 << 12 };

fuzz_target!(|bytes: &[u8]| {
    let Ok(raster) = netcdf::decode(bytes, LIMITS) else { return };
    assert!(raster.field.size().cells() <= LIMITS.cells);
    let written = netcdf::encode(&raster).expect("a raster that was read is finite");
    let again = netcdf::decode(&written, LIMITS).expect("what was written can be read");
    assert_eq!((again.field, again.valid), (raster.field, raster.valid));
});
