//! Any bytes are a raster or a fault; what was read is written and read again the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{Limits, geotiff};

const LIMITS: Limits = Limits { cells: 1 << 12 };

/// What is written has tiles of 256 × 256 cells.
const OWN: Limits = Limits { cells: 1 << 16 };

fuzz_target!(|bytes: &[u8]| {
    let Ok(raster) = geotiff::decode(bytes, LIMITS) else { return };
    assert!(raster.field.size().cells() <= LIMITS.cells);
    // Packing a tile costs a thousand times what reading a small file does, so one file in sixteen goes round.
    if raster.field.size().cells() <= 256 && bytes.len().is_multiple_of(16) {
        let written = geotiff::encode(&raster).expect("a raster that was read is finite");
        let again = geotiff::decode(&written, OWN).expect("what was written can be read");
        assert_eq!((again.field, again.valid), (raster.field, raster.valid));
    }
});
