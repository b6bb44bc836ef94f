//! Any bytes as a chunk that is packed with LZ4.
#![no_main]

mod chunk;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| chunk::unpack("{\"id\": \"lz4\", \"acceleration\": 1}", bytes));
