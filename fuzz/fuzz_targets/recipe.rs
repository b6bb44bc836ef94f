//! Any text is a table or a complaint with a line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::recipe::source;

fuzz_target!(|text: &str| {
    if let Err(error) = source::parse("fuzz.toml", text) {
        assert!(error.complaints.iter().all(|complaint| complaint.line >= 1));
    }
});
