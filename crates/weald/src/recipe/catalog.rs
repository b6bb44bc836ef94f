//! Every step there is. Adding one is one file and one line here.

use crate::step::Entry;

/// All steps, in the order of `weald steps`.
pub const CATALOG: &[Entry] = &[];

/// The step of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    CATALOG.iter().find(|entry| entry.name == name)
}
