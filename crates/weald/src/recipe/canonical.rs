//! A recipe in one spelling: what its hash is taken of.
//!
//! Comments, the order of keys and the place of overrides do not matter to a run, so they do not matter here:
//! keys are sorted, one a line. The text is itself a recipe that gives the same run.

use std::fmt::Write;

use super::source::{Node, Table, Value};

/// The text of a recipe after overrides.
pub(super) fn text(recipe: &Table) -> String {
    let mut text = String::new();
    for section in ["landscape", "material", "fractal", "step", "output"] {
        match recipe.get(section).map(|node| &node.value) {
            Some(Value::Table(table)) => write_section(&mut text, &format!("[{section}]"), table),
            Some(Value::List(items)) => {
                for table in items.iter().filter_map(as_table) {
                    write_section(&mut text, &format!("[[{section}]]"), table);
                }
            }
            _ => {}
        }
    }
    text
}

/// The keys of one table, each on a line.
pub(super) fn keys(table: &Table) -> String {
    let mut text = String::new();
    write_section(&mut text, "", table);
    text
}

fn as_table(node: &Node) -> Option<&Table> {
    match &node.value {
        Value::Table(table) => Some(table),
        _ => None,
    }
}

fn write_section(text: &mut String, header: &str, table: &Table) {
    let _ = writeln!(text, "{header}");
    for (key, node) in sorted(table) {
        let _ = writeln!(text, "{} = {}", bare_or_quoted(key), in_toml(&node.value));
    }
}

fn sorted(table: &Table) -> Vec<&(String, Node)> {
    let mut entries: Vec<_> = table.entries.iter().collect();
    entries.sort_by(|a, b| a.0.cmp(&b.0));
    entries
}

fn in_toml(value: &Value) -> String {
    match value {
        Value::Flag(_) | Value::Integer(_) | Value::Number(_) => value.shown(),
        Value::Text(text) => quoted(text),
        Value::List(items) => {
            let items: Vec<_> = items.iter().map(|item| in_toml(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) => {
            let entry =
                |(key, node): &(String, Node)| format!("{} = {}", bare_or_quoted(key), in_toml(&node.value));
            let entries: Vec<_> = sorted(table).into_iter().map(entry).collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

fn bare_or_quoted(key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(bare) { key.to_owned() } else { quoted(key) }
}

/// A TOML basic string. JSON escapes what TOML wants escaped, except for DEL.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use weald_core::source::parse;

    #[test]
    fn order_and_comments_leave_no_trace() {
        let one = parse("r", "# hi\n[landscape]\nsize = 4\ncell = 2.0\n").expect("parses");
        let two = parse("r", "[landscape]\ncell = 2.0 # metres\n\nsize = 4\n").expect("parses");
        assert_eq!(text(&one), text(&two));
        assert_eq!(text(&one), "[landscape]\ncell = 2.0\nsize = 4\n");
    }

    proptest! {
        #[test]
        fn the_text_says_the_same_when_read_again(
            name in any::<String>(), number in any::<f64>().prop_filter("finite", |n| n.is_finite()),
            key in any::<String>(),
        ) {
            let node = |value| Node { line: 1, value };
            let inner = Table { line: 1, entries: vec![(key, node(Value::Number(number)))] };
            let entries = vec![
                ("do".to_owned(), node(Value::Text(name))),
                ("with".to_owned(), node(Value::Table(inner))),
            ];
            let steps = Value::List(vec![node(Value::Table(Table { line: 1, entries }))]);
            let recipe = Table { line: 1, entries: vec![("step".to_owned(), node(steps))] };
            let once = text(&recipe);
            prop_assert_eq!(text(&parse("r", &once).expect("canonical text is TOML")), once);
        }
    }
}
