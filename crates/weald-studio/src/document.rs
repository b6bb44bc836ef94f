//! A recipe under a person's hands. The text is what counts: cards and controls change it, comments and order stay, and
//! what is typed into it changes the cards.

mod changes;
mod density;
mod renaming;

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
}

#[cfg(test)]
mod tests;
