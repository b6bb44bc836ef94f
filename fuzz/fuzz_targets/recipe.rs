//! Any text is a checked recipe or complaints with their lines.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::Error;
use weald::recipe::{Overrides, Recipe};

fuzz_target!(|text: &str| {
    if let Err(Error::Recipe(error)) = Recipe::parse("fuzz.toml", text, &Overrides::default()) {
        assert!(error.diagnostics.iter().all(|diagnostic| diagnostic.line >= 1));
    }
});
