//! Any bytes as a chunk that is packed with Blosc.
#![no_main]

mod chunk;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| chunk::unpack("{\"id\": \"blosc\", \"cname\": \"lz4\", \"clevel\": 5, \"shuffle\": 1, \"blocksize\": 0}", bytes));
