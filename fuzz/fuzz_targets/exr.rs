//! Any bytes are a raster or a fault; what was read is written and read again the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{Limits, exr};

const LIMITS: Limits = Limits { cells: 1 << 12 };

fuzz_target!(|bytes: &[u8]| {
    let Ok(raster) = exr::decode(bytes, LIMITS) else { return };
    assert!(raster.field.size().cells() <= LIMITS.cells);
    // Packing costs many times what reading a small file does, so one file in eight goes round.
    if raster.field.size().cells() <= 1024 && bytes.len().is_multiple_of(8) {
        let written = exr::encode(&raster).expect("a raster that was read is finite");
        let again = exr::decode(&written, LIMITS).expect("what was written can be read");
        assert_eq!((again.field, again.valid), (raster.field, raster.valid));
        assert_eq!((again.cell, again.georeference), (raster.cell, raster.georeference));
    }
});
