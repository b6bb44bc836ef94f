//! Any numbers with any description beside them are a raster or a fault; what was read is written as floats and
//! read again the same. The input is the description, a NUL, and the numbers; without a NUL, the numbers alone.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{InMemory, Limits, Part, raw};

const LIMITS: Limits = Limits { cells: 1 << 16 };

fuzz_target!(|bytes: &[u8]| {
    let parts = match bytes.iter().position(|&byte| byte == 0) {
        Some(end) => vec![Part::beside(".json", bytes[..end].to_vec()), Part::own(bytes[end + 1..].to_vec())],
        None => vec![Part::own(bytes.to_vec())],
    };
    for decode in [raw::decode_16, raw::decode_32] {
        let Ok(raster) = decode(&InMemory::of("land.raw", parts.clone()), LIMITS) else { continue };
        assert!(raster.field.size().cells() <= LIMITS.cells);
        let written = raw::encode_32(&raster).expect("a raster that was read is finite");
        let again = raw::decode_32(&InMemory::of("land.r32", written), LIMITS).expect("what was written is read");
        assert_eq!((again.field, again.valid), (raster.field.clone(), raster.valid.clone()));
        assert_eq!((again.cell, &again.georeference), (raster.cell, &raster.georeference));
        let written = raw::encode_16(&raster).expect("a raster that was read is finite");
        let again = raw::decode_16(&InMemory::of("land.r16", written), LIMITS).expect("what was written is read");
        assert_eq!(again.valid, raster.valid);
    }
});
