//! Any bytes as the strip of a GeoTIFF that is packed with PackBits.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{Limits, geotiff};

const LIMITS: Limits = Limits { cells: 1 << 16 };

fuzz_target!(|bytes: &[u8]| {
    // Tag, type (3 short, 4 long), value: 32 × 32 bytes in one strip behind the directory.
    let tags: [(u16, u16, u32); 9] = [
        (256, 3, 32),
        (257, 3, 32),
        (258, 3, 8),
        (259, 3, 32773),
        (262, 3, 1),
        (273, 4, 8 + 2 + 9 * 12 + 4),
        (277, 3, 1),
        (278, 3, 32),
        (279, 4, bytes.len() as u32),
    ];
    let mut file = b"II\x2a\0\x08\0\0\0\x09\0".to_vec();
    for (tag, kind, value) in tags {
        file.extend(tag.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(1_u32.to_le_bytes());
        file.extend(value.to_le_bytes());
    }
    file.extend([0; 4]);
    file.extend(bytes);
    if let Ok(raster) = geotiff::decode(&file, LIMITS) {
        assert_eq!(raster.field.size().cells(), 32 * 32);
    }
});
