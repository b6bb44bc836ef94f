//! What cards and controls change in a text: keys of its steps and of `[landscape]`, and which steps there are.

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table as EditedTable};

use super::Document;

impl Document {
    /// Sets a key of a step, counted from 0, or takes it out; one within a table has its name behind a point. `value` is
    /// in TOML notation.
    ///
    /// # Errors
    /// A sentence for a value that is no TOML, and where the text cannot be changed by a control.
    pub fn set_step_key(&mut self, step: usize, key: &str, value: Option<&str>) -> Result<(), String> {
        let change = described(&format!("step {}", step + 1), key, value);
        self.edit(change, |document| set(step_of(document, step)?, key, value))
    }

    /// The same of a key of `[landscape]`.
    ///
    /// # Errors
    /// As [`Document::set_step_key`].
    pub fn set_landscape_key(&mut self, key: &str, value: Option<&str>) -> Result<(), String> {
        let change = described("landscape", key, value);
        self.edit(change, |document| {
            let landscape = document.entry("landscape").or_insert(Item::Table(EditedTable::new()));
            set(
                landscape.as_table_mut().ok_or("[landscape] is no table of its own; change the text")?,
                key,
                value,
            )
        })
    }

    /// Puts a step of this name before the step at a place, counted from 0, or at the end, with all keys at their defaults.
    ///
    /// # Errors
    /// As [`Document::set_step_key`].
    pub fn add_step(&mut self, name: &str, at: usize) -> Result<(), String> {
        let mut table = EditedTable::new();
        table.insert("do", toml_edit::value(name));
        self.rearrange(format!("add {name}"), |steps| {
            steps.insert(at.min(steps.len()), table);
            Ok(())
        })
    }

    /// Takes a step out.
    ///
    /// # Errors
    /// As [`Document::set_step_key`].
    pub fn remove_step(&mut self, at: usize) -> Result<(), String> {
        self.rearrange(format!("remove step {}", at + 1), |steps| {
            taken(steps, at)?;
            Ok(())
        })
    }

    /// Puts a copy of a step after it.
    ///
    /// # Errors
    /// As [`Document::set_step_key`].
    pub fn duplicate_step(&mut self, at: usize) -> Result<(), String> {
        self.rearrange(format!("duplicate step {}", at + 1), |steps| {
            let table = steps.get(at).cloned().ok_or_else(|| no_step(at))?;
            steps.insert(at + 1, table);
            Ok(())
        })
    }

    /// Puts a step where another is.
    ///
    /// # Errors
    /// As [`Document::set_step_key`].
    pub fn move_step(&mut self, from: usize, to: usize) -> Result<(), String> {
        self.rearrange(format!("move step {} to {}", from + 1, to + 1), |steps| {
            let table = taken(steps, from)?;
            steps.insert(to.min(steps.len()), table);
            Ok(())
        })
    }

    fn rearrange(
        &mut self,
        change: String,
        how: impl FnOnce(&mut Vec<EditedTable>) -> Result<(), String>,
    ) -> Result<(), String> {
        self.edit(change, |document| {
            let item = document.entry("step").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
            rearranged(item.as_array_of_tables_mut().ok_or(NOT_IN_TABLES)?, how)
        })
    }

    pub(super) fn edit(
        &mut self,
        change: String,
        how: impl FnOnce(&mut DocumentMut) -> Result<(), String>,
    ) -> Result<(), String> {
        let parsed = self.text.parse::<DocumentMut>();
        let mut document = parsed.map_err(|error| format!("the text is no TOML yet: {}", error.message()))?;
        how(&mut document)?;
        self.take(document.to_string(), change);
        Ok(())
    }
}

/// Changes which tables there are, or their order.
pub(super) fn rearranged(
    steps: &mut ArrayOfTables,
    how: impl FnOnce(&mut Vec<EditedTable>) -> Result<(), String>,
) -> Result<(), String> {
    let mut tables: Vec<EditedTable> = steps.iter().cloned().collect();
    let mut places: Vec<_> = tables.iter().filter_map(EditedTable::position).collect();
    how(&mut tables)?;
    // Tables stand in the text by their positions: the steps share those that they had, the last one with what is new.
    places.resize(tables.len(), places.last().copied().unwrap_or(isize::MAX));
    steps.clear();
    for (mut table, place) in tables.into_iter().zip(places) {
        table.set_position(Some(place));
        steps.push(table);
    }
    Ok(())
}

pub(super) const NOT_IN_TABLES: &str = "the steps are no [[step]] tables; change the text";

fn described(of: &str, key: &str, value: Option<&str>) -> String {
    value.map_or_else(|| format!("{of}: {key} as by default"), |value| format!("{of}: {key} = {value}"))
}

pub(super) fn no_step(at: usize) -> String {
    format!("there is no step {}", at + 1)
}

fn taken(steps: &mut Vec<EditedTable>, at: usize) -> Result<EditedTable, String> {
    if at < steps.len() { Ok(steps.remove(at)) } else { Err(no_step(at)) }
}

pub(super) fn step_of(document: &mut DocumentMut, at: usize) -> Result<&mut EditedTable, String> {
    let steps = document.get_mut("step").and_then(Item::as_array_of_tables_mut).ok_or(NOT_IN_TABLES)?;
    steps.get_mut(at).ok_or_else(|| no_step(at))
}

/// Sets a key of a table, or takes it out; a table within that is left empty goes too.
fn set(table: &mut dyn toml_edit::TableLike, key: &str, value: Option<&str>) -> Result<(), String> {
    let Some((outer, inner)) = key.split_once('.') else {
        match value {
            Some(text) => put(table, key, text)?,
            None => drop(table.remove(key)),
        }
        return Ok(());
    };
    let empty = || toml_edit::value(toml_edit::InlineTable::new());
    let within = table.entry(outer).or_insert_with(empty);
    let within = within.as_table_like_mut().ok_or_else(|| format!("`{outer}` is no table"))?;
    set(within, inner, value)?;
    if within.is_empty() {
        table.remove(outer);
    }
    Ok(())
}

/// The new value takes over the comment of the old one.
pub(super) fn put(table: &mut dyn toml_edit::TableLike, key: &str, text: &str) -> Result<(), String> {
    let mut value: toml_edit::Value =
        text.parse().map_err(|_| format!("{key} = {text} is no TOML; text stands in quotes"))?;
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(key, Item::Value(value));
    Ok(())
}
