//! A script in JSON lines as tables that know their lines.

use std::fmt::{self, Formatter};

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use weald_core::parameter::Diagnostics;
use weald_core::source::{Node, Table, Value};

/// After so many faults no more are looked for.
pub(super) const MAX_FAULTS: usize = 50;

/// Most keys of a table, which are compared with each other.
const MAX_KEYS: usize = 100;

/// The tables of a text; lines that are none are told.
pub(super) fn json_lines(text: &str, diagnostics: &mut Diagnostics) -> Vec<Table> {
    let mut tables = Vec::new();
    for (index, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
        let line = index + 1;
        match serde_json::from_str(text).map(|Json(value)| at_line(value, line)) {
            Ok(Value::Table(table)) => tables.push(table),
            Ok(other) => diagnostics.add(line, format!("is {}, but must be {{ … }}", other.shown())),
            Err(error) => diagnostics.add(line, no_json(&error)),
        }
        if diagnostics.found.len() >= MAX_FAULTS {
            break;
        }
    }
    tables
}

/// The parser counts lines within the one that it was given.
fn no_json(error: &serde_json::Error) -> String {
    let full = error.to_string();
    let what = full.split(" at line ").next().unwrap_or(&full);
    if error.is_data() {
        return format!("column {}: {what}", error.column());
    }
    format!("is no JSON at column {}: {what}; an edit is one line, {{ … }}", error.column())
}

/// A value of JSON, whose nodes have no line yet.
struct Json(Value);

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        json.deserialize_any(ValueVisitor).map(Self)
    }
}

/// Takes every key as it comes: a map of serde's would keep the last of two that are called alike, and forget their order.
struct ValueVisitor;

impl<'de> Visitor<'de> for ValueVisitor {
    type Value = Value;

    fn expecting(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str("a value of JSON")
    }

    fn visit_bool<E: Error>(self, flag: bool) -> Result<Value, E> {
        Ok(Value::Flag(flag))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Value, E> {
        Ok(Value::Integer(number))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Value, E> {
        Ok(i64::try_from(number).map_or(Value::Number(number as f64), Value::Integer))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Value, E> {
        Ok(Value::Number(number))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Value, E> {
        Ok(Value::Text(text.to_owned()))
    }

    /// JSON's nothing is no value of any key.
    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Text("null".to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Json(value)) = items.next_element()? {
            list.push(Node { line: 0, value });
        }
        Ok(Value::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut table = Table::default();
        while let Some((key, Json(value))) = entries.next_entry::<String, Json>()? {
            if table.entries.len() == MAX_KEYS {
                return Err(A::Error::custom(format!("more than {MAX_KEYS} keys; an edit has a dozen")));
            }
            if table.get(&key).is_some() {
                return Err(A::Error::custom(format!("duplicate key: `{key}`")));
            }
            table.entries.push((key, Node { line: 0, value }));
        }
        Ok(Value::Table(table))
    }
}

/// The value with all that is in it on a line.
fn at_line(value: Value, line: usize) -> Value {
    let placed = |node: Node| Node { line, value: at_line(node.value, line) };
    match value {
        Value::List(items) => Value::List(items.into_iter().map(placed).collect()),
        Value::Table(Table { entries, .. }) => {
            let entries = entries.into_iter().map(|(key, node)| (key, placed(node))).collect();
            Value::Table(Table { line, entries })
        }
        plain => plain,
    }
}
