//! The faults of a recipe, collected while it is read.

use crate::error::Diagnostic;
use crate::source::Table;

/// Collects the faults of a recipe while it is read.
#[derive(Debug, Default)]
pub struct Diagnostics {
    /// What the keys belong to, for the message: `thermal`, `landscape`.
    pub subject: String,
    /// All faults so far.
    pub found: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Adds a fault, prefixed with its subject.
    pub fn add(&mut self, line: usize, message: impl std::fmt::Display) {
        let message = if self.subject.is_empty() {
            message.to_string()
        } else {
            format!("{}: {message}", self.subject)
        };
        self.found.push(Diagnostic { line, message });
    }

    /// Complains of every key of `table` that is not among `known`, with the nearest known name.
    pub fn unknown_keys(&mut self, table: &Table, known: &[&str]) {
        for (key, node) in &table.entries {
            if !known.contains(&key.as_str()) {
                let hint = match nearest(key, known) {
                    Some(name) => format!("; did you mean `{name}`?"),
                    None => format!("; the keys here are: {}", known.join(", ")),
                };
                self.add(node.line, format!("unknown key `{key}`{hint}"));
            }
        }
    }
}

/// The known name that was probably meant.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let scored = known.iter().map(|name| (strsim::jaro_winkler(word, name), *name));
    scored.filter(|(score, _)| *score > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}
