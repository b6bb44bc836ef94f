//! The faults of a recipe, collected while it is read.

use crate::error::Diagnostic;
use crate::source::{Node, Table, Value};

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

    /// Does something about a value; faults within its table, or the tables in its list, are those of the key.
    pub(super) fn within<T>(&mut self, key: &str, node: &Node, read: impl FnOnce(&mut Self) -> T) -> T {
        if !matches!(node.value, Value::Table(_) | Value::List(_)) {
            return read(self);
        }
        let outer = self.subject.clone();
        self.subject = if outer.is_empty() { key.to_owned() } else { format!("{outer}.{key}") };
        let value = read(self);
        self.subject = outer;
        value
    }

    /// Adds to the faults from `first` on that name the range of a key of this subject.
    pub(super) fn append_to_ranges(&mut self, first: usize, text: &str) {
        let of_key = if self.subject.is_empty() { "`".to_owned() } else { format!("{}: `", self.subject) };
        for Diagnostic { message, .. } in &mut self.found[first..] {
            if message.starts_with(&of_key) && message.contains(", outside its range: ") {
                message.push_str(text);
            }
        }
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

/// Words of hydrology and of other programs for what a recipe calls by another name.
const SYNONYMS: &[(&str, &str)] = &[
    ("accumulate", "flow"),
    ("accumulation", "flow"),
    ("basins", "watersheds"),
    ("breach", "flow"),
    ("camera", "eye"),
    ("catchment", "watersheds"),
    ("catchments", "watersheds"),
    ("contributing_area", "accumulation"),
    ("dem", "height"),
    ("drainage", "flow"),
    ("drainage_area", "accumulation"),
    ("dt", "flow_rate"),
    ("elevation", "height"),
    ("erodibility", "erosion"),
    ("fill", "flow"),
    ("fov", "field_of_view_deg"),
    ("fps", "frames_per_second"),
    ("frame_rate", "frames_per_second"),
    ("hand", "moisture"),
    ("height", "size"),
    ("hillshade", "relief"),
    ("infill", "flow"),
    ("look_at", "target"),
    ("max_depth", "deepest_breach"),
    ("pipe_constant", "flow_rate"),
    ("position", "eye"),
    ("resolution", "size"),
    ("resolution", "width"),
    ("runoff", "weight"),
    ("size", "width"),
    ("steps", "iterations"),
    ("threshold", "area"),
    ("topography", "height"),
    ("twi", "wetness"),
    ("upslope_area", "accumulation"),
    ("upstream_area", "accumulation"),
    ("width", "size"),
];

/// The known name of what the field or another program calls `word`.
pub fn synonym<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    known.iter().find(|name| SYNONYMS.contains(&(word, **name))).copied()
}

/// The known name that was probably meant: what the field calls otherwise, or what is spelled alike.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if let Some(name) = synonym(word, known) {
        return Some(name);
    }
    let scored = known.iter().map(|name| (strsim::jaro_winkler(word, name), *name));
    scored.filter(|(score, _)| *score > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}
