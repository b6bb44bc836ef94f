//! Any bytes as a chunk that is packed with Zstandard.
#![no_main]

mod chunk;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| chunk::unpack("{\"id\": \"zstd\", \"level\": 1}", bytes));
