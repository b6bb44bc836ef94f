//! Any bytes are a raster or a fault; what was read can be written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{Limits, png16};

const LIMITS: Limits = Limits { cells: 1 << 16 };

fuzz_target!(|bytes: &[u8]| {
    let Ok(raster) = png16::decode(bytes, LIMITS) else { return };
    assert!(raster.field.size().cells() <= LIMITS.cells);
    let written = png16::encode(&raster).expect("a raster that was read is finite");
    let again = png16::decode(&written, LIMITS).expect("what was written can be read");
    assert_eq!((again.field.size(), again.valid), (raster.field.size(), raster.valid));
});
