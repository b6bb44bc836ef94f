//! A recipe under a person's hands. The text is what counts: cards and controls change it, comments and order stay, and
//! what is typed into it changes the cards.

mod density;
mod renaming;

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table as EditedTable};
use weald::Error;
use weald::error::Diagnostic;
use weald::recipe::source::{self, Node, Table, Value};
use weald::recipe::{Overrides, Recipe};

/// Most texts that are kept to go back to.
const MOST_KEPT: usize = 500;

/// The text of a recipe, what it says, and the texts before and after it.
#[derive(Debug)]
pub struct Document {
    file: String,
    text: String,
    table: Table,
    diagnostics: Vec<Diagnostic>,
    revision: u64,
    before: Vec<Said>,
    after: Vec<Said>,
}

/// A text, and what made another one of it.
#[derive(Clone, Debug)]
struct Said {
    text: String,
    change: String,
}

impl Document {
    /// A recipe with the name of its file, from whose folder paths in it start.
    pub fn new(file: impl Into<String>, text: impl Into<String>) -> Self {
        let (file, text) = (file.into(), text.into());
        let mut document = Self {
            file,
            text,
            table: Table::default(),
            diagnostics: Vec::new(),
            revision: 0,
            before: Vec::new(),
            after: Vec::new(),
        };
        document.read();
        document
    }

    /// Name of the file.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// How many times it has changed.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// What is wrong with it, by lines; empty for a recipe that can run.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The `[[step]]` tables, as far as the text is TOML.
    pub fn steps(&self) -> Vec<&Table> {
        let Some(Node { value: Value::List(items), .. }) = self.table.get("step") else { return Vec::new() };
        let tables = items.iter().filter_map(|item| match &item.value {
            Value::Table(table) => Some(table),
            _ => None,
        });
        tables.collect()
    }

    /// What a step does: the word after `do =`.
    pub fn word(step: &Table) -> &str {
        match step.get("do") {
            Some(Node { value: Value::Text(name), .. }) => name,
            _ => "",
        }
    }

    /// The `[landscape]` table.
    pub fn landscape(&self) -> Table {
        match self.table.get("landscape") {
            Some(Node { value: Value::Table(table), .. }) => table.clone(),
            _ => Table::default(),
        }
    }

    /// Whether a step is left out.
    pub fn is_off(step: &Table) -> bool {
        matches!(step.get("off"), Some(Node { value: Value::Flag(true), .. }))
    }

    /// How many steps run up to this one.
    pub fn running_until(&self, last: usize) -> usize {
        self.steps().iter().take(last + 1).filter(|step| !Self::is_off(step)).count()
    }

    /// Takes another text, as typed. The text before it is kept; what is typed on at once with the last is one change.
    pub fn type_text(&mut self, text: &str) {
        const TYPED: &str = "typed";
        if text == self.text {
            return;
        }
        let goes_on = self.before.last().is_some_and(|said| said.change == TYPED) && self.after.is_empty();
        if goes_on {
            text.clone_into(&mut self.text);
            self.read();
        } else {
            self.take(text.to_owned(), TYPED.to_owned());
        }
    }

    /// Takes another text that a change of this name made.
    fn take(&mut self, text: String, change: String) {
        if text == self.text {
            return;
        }
        let text = std::mem::replace(&mut self.text, text);
        self.before.push(Said { text, change });
        if self.before.len() > MOST_KEPT {
            self.before.remove(0);
        }
        self.after.clear();
        self.read();
    }

    fn read(&mut self) {
        self.revision += 1;
        match source::parse(&self.file, &self.text) {
            Ok(table) => self.table = table,
            Err(error) => {
                self.diagnostics = error.diagnostics;
                return;
            }
        }
        self.diagnostics = match Recipe::parse(&self.file, &self.text, &Overrides::default()) {
            Ok(_) => Vec::new(),
            Err(Error::Recipe(error)) => error.diagnostics,
            Err(other) => vec![Diagnostic { line: Diagnostic::NO_LINE, message: other.to_string() }],
        };
    }

    /// Takes the last change back; `false` where there is none.
    pub fn undo(&mut self) -> bool {
        let Some(said) = self.before.pop() else { return false };
        let text = std::mem::replace(&mut self.text, said.text);
        self.after.push(Said { text, change: said.change });
        self.read();
        true
    }

    /// Makes the change again that was taken back last; `false` where there is none.
    pub fn redo(&mut self) -> bool {
        let Some(said) = self.after.pop() else { return false };
        let text = std::mem::replace(&mut self.text, said.text);
        self.before.push(Said { text, change: said.change });
        self.read();
        true
    }

    /// The changes so far, oldest first.
    pub fn changes(&self) -> impl Iterator<Item = &str> {
        self.before.iter().map(|said| said.change.as_str())
    }

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

    fn edit(
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
fn rearranged(
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

const NOT_IN_TABLES: &str = "the steps are no [[step]] tables; change the text";

fn described(of: &str, key: &str, value: Option<&str>) -> String {
    value.map_or_else(|| format!("{of}: {key} as by default"), |value| format!("{of}: {key} = {value}"))
}

fn no_step(at: usize) -> String {
    format!("there is no step {}", at + 1)
}

fn taken(steps: &mut Vec<EditedTable>, at: usize) -> Result<EditedTable, String> {
    if at < steps.len() { Ok(steps.remove(at)) } else { Err(no_step(at)) }
}

fn step_of(document: &mut DocumentMut, at: usize) -> Result<&mut EditedTable, String> {
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
fn put(table: &mut dyn toml_edit::TableLike, key: &str, text: &str) -> Result<(), String> {
    let mut value: toml_edit::Value =
        text.parse().map_err(|_| format!("{key} = {text} is no TOML; text stands in quotes"))?;
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(key, Item::Value(value));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# a valley\n[landscape]\nsize = 64 # cells\ncell = 20.0\n\n\
        # ground\n[[step]]\ndo = \"diamond-square\"\nrelief = 200.0 # metres\n\n\
        # carve\n[[step]]\ndo = \"thermal\"\n\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";

    #[test]
    fn a_control_changes_one_line_and_leaves_comments_and_order() {
        let mut document = Document::new("valley.toml", TEXT);
        document.set_step_key(0, "relief", Some("300.0")).expect("there");
        assert_eq!(document.text(), TEXT.replace("200.0", "300.0"));
        document.set_landscape_key("seed", Some("5")).expect("there");
        assert!(document.text().contains("seed = 5"));
        assert!(document.diagnostics().is_empty(), "{:?}", document.diagnostics());
        assert!(document.undo() && document.undo() && !document.undo());
        assert_eq!(document.text(), TEXT);
        assert!(document.redo());
        assert_eq!(document.changes().collect::<Vec<_>>(), ["step 1: relief = 300.0"]);
    }

    #[test]
    fn steps_move_with_their_comments_and_come_before_the_outputs() {
        let mut document = Document::new("valley.toml", TEXT);
        document.duplicate_step(1).expect("there");
        document.add_step("slope", 9).expect("at the end");
        let words = |document: &Document| {
            document.steps().iter().map(|step| Document::word(step).to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(words(&document), ["diamond-square", "thermal", "thermal", "slope"]);
        assert!(document.text().ends_with("file = \"height.tif\"\n"), "{}", document.text());
        document.move_step(3, 1).expect("there");
        document.remove_step(3).expect("there");
        assert_eq!(words(&document), ["diamond-square", "slope", "thermal"]);
        assert!(document.text().contains("# carve\n[[step]]\ndo = \"thermal\""), "{}", document.text());
        assert!(document.diagnostics().is_empty(), "{:?}\n{}", document.diagnostics(), document.text());
        assert!(document.remove_step(7).is_err());
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line_and_the_cards_stay() {
        let mut document = Document::new("valley.toml", TEXT);
        document.type_text(&TEXT.replace("relief", "releif"));
        assert_eq!(document.diagnostics()[0].line, 9);
        document.type_text("[landscape\n");
        assert_eq!(document.diagnostics()[0].line, 1);
        assert_eq!(document.steps().len(), 2, "as they were last understood");
        assert!(document.set_step_key(0, "relief", Some("1.0")).is_err(), "the text is no TOML");
        document.type_text(TEXT);
        assert!(document.set_step_key(0, "relief", Some("no toml")).is_err());
        assert!(document.undo(), "all that was typed is one change");
        assert_eq!(document.text(), TEXT);
    }

    #[test]
    fn a_key_within_a_table_is_set_and_taken_out_with_its_table() {
        let mut document = Document::new("valley.toml", TEXT);
        document.set_step_key(1, "a.b", Some("2.0")).expect("a table within");
        assert!(document.text().contains("a = { b = 2.0 }"), "{}", document.text());
        document.set_step_key(1, "a.b", None).expect("there");
        assert_eq!(document.text(), TEXT);
    }
}
