//! What a key depends on to have an effect.

use super::kind::{Needs, Parameter};
use crate::source::{Table, Value};

impl Needs {
    /// Whether a table fulfils it; `parameters` have the defaults of keys that are absent.
    pub fn is_met(&self, table: &Table, parameters: &[&Parameter]) -> bool {
        let value = |key: &str| value_of(table, parameters, key);
        match self {
            Self::Value(key, values) => value(key).is_some_and(|value| values.contains(&value.as_str())),
            Self::OtherValue(key, values) => {
                !value(key).is_some_and(|value| values.contains(&value.as_str()))
            }
            Self::Given(keys) => keys.iter().any(|key| table.get(key).is_some()),
            Self::Absent(key) => table.get(key).is_none(),
            Self::File(extensions) => extension_of(table)
                .is_none_or(|extension| extensions.iter().any(|legal| legal.eq_ignore_ascii_case(extension))),
        }
    }

    /// Why a key has no effect in a table that does not fulfil it, and what to do about it.
    pub(super) fn diagnostic(&self, table: &Table, parameters: &[&Parameter]) -> String {
        let unmet = |key: &str| match value_of(table, parameters, key) {
            Some(value) => format!("with {key} = {value}"),
            None => format!("without `{key}`"),
        };
        match self {
            Self::Value(key, values) => {
                let unmet = unmet(key);
                format!(
                    "has no effect {unmet}: it needs {key} = {}; set that, or remove it",
                    values.join(" or ")
                )
            }
            Self::OtherValue(key, _) => {
                format!("has no effect {}; choose another, or remove it", unmet(key))
            }
            Self::Given(keys) => {
                let keys: Vec<_> = keys.iter().map(|key| format!("`{key}`")).collect();
                let keys = keys.join(" or ");
                format!("has no effect without {keys}; add {keys}, or remove it")
            }
            Self::Absent(key) => format!("has no effect beside `{key}`; remove either"),
            Self::File(extensions) => {
                let (extension, legal) = (extension_of(table).unwrap_or_default(), extensions.join(" or ."));
                format!("has no effect in a .{extension}: it is for a .{legal}; write that, or remove it")
            }
        }
    }

    /// The condition as an end of a sentence on the key, for `weald steps`.
    pub fn in_words(&self) -> String {
        match self {
            Self::Value(key, values) => format!("only with {key} = {}", values.join(" or ")),
            Self::OtherValue(key, values) => format!("not with {key} = {}", values.join(" or ")),
            Self::Given(keys) => format!("only with `{}`", keys.join("` or `")),
            Self::Absent(key) => format!("not with `{key}`"),
            Self::File(extensions) => format!("only in a .{}", extensions.join(" or .")),
        }
    }
}

/// The extension of the file of an output.
fn extension_of(table: &Table) -> Option<&str> {
    match &table.get("file")?.value {
        Value::Text(name) => name.rsplit_once('.').map(|(_, extension)| extension),
        _ => None,
    }
}

/// The value that a key has in a table, as given or by default, in TOML notation.
fn value_of(table: &Table, parameters: &[&Parameter], key: &str) -> Option<String> {
    match table.get(key) {
        Some(node) => Some(node.value.shown()),
        None => parameters.iter().find(|parameter| parameter.name == key)?.default.clone(),
    }
}
