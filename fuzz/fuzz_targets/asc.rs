//! Any text, with any CRS beside it, is a raster or a fault; what was read is written and read again the same.
//! The input is the CRS, a NUL, and the grid; without a NUL, the grid alone.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{InMemory, Limits, Part, asc};

const LIMITS: Limits = Limits { cells: 1 << 16 };

fuzz_target!(|bytes: &[u8]| {
    let parts = match bytes.iter().position(|&byte| byte == 0) {
        Some(end) => vec![Part::sibling(".prj", bytes[..end].to_vec()), Part::own(bytes[end + 1..].to_vec())],
        None => vec![Part::own(bytes.to_vec())],
    };
    let Ok(raster) = asc::decode(&InMemory::of("land.asc", parts), LIMITS) else { return };
    assert!(raster.field.size().cells() <= LIMITS.cells);
    let written = asc::encode(&raster).expect("a raster that was read is finite");
    let again = asc::decode(&InMemory::of("land.asc", written), LIMITS).expect("what was written is read");
    assert_eq!((again.field, again.valid), (raster.field, raster.valid));
});
