//! Any text is a script that reads again as it was written, or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::edit::{Layout, Script};

fuzz_target!(|text: &str| {
    for layout in [Layout::JsonLines, Layout::Toml] {
        let Ok(script) = Script::parse("fuzz", text, layout, &["rock", "sand", "soil"]) else { continue };
        let written = script.text(layout);
        let again = Script::parse("fuzz", &written, layout, &["rock", "sand", "soil"]);
        assert_eq!(again.expect("what was written reads"), script);
    }
});
