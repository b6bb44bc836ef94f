//! An interactive session as data: which stroke happens before which iteration, so that it replays to the same
//! bits.
//!
//! The extension of a file chooses its layout. In JSON lines (`.jsonl`, `.ndjson`) each line is an edit:
//!
//! ```json
//! {"step": 120, "do": "add", "material": "soil", "thickness": 2.5, "path": [[400, 300], [900, 320]], "radius": 40}
//! ```
//!
//! In TOML each edit is a table `[[edit]]` of the same keys, which [`EditKeys`](super::EditKeys) explains.

use super::change::Edit;
use std::io::Read;
use std::path::Path;

use super::json_lines::{MAX_FAULTS, json_lines};
use super::keys;
use weald_core::error::{Diagnostic, Error, Limit, Quantity, RecipeError};
use weald_core::files::File;
use weald_core::parameter::Diagnostics;
use weald_core::source::{self, Node, Table, Value};
use weald_io::write_whole;

/// Longest script that is read, in bytes; in TOML it is that of a recipe.
pub const MAX_BYTES: usize = 16 << 20;

/// Most strokes of a script.
pub const MAX_STROKES: usize = 100_000;

/// How a script is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// A line of JSON an edit.
    JsonLines,
    /// A table `[[edit]]` an edit.
    Toml,
}

impl Layout {
    /// The layout of a file name.
    ///
    /// # Errors
    /// A sentence that names the extensions there are.
    pub fn of(path: &Path) -> Result<Self, String> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        match extension.as_str() {
            "jsonl" | "ndjson" => Ok(Self::JsonLines),
            "toml" => Ok(Self::Toml),
            _ => Err(format!(
                "the extension of `{}` names no kind of script; there are .jsonl .ndjson .toml",
                path.display()
            )),
        }
    }
}

/// Edits in the order of their steps; those of one step in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    edits: Vec<Edit>,
}

impl Script {
    /// A script of these edits, in any order.
    pub fn new(mut edits: Vec<Edit>) -> Self {
        edits.sort_by_key(|edit| edit.step);
        Self { edits }
    }

    /// All edits, in the order in which they happen.
    pub fn edits(&self) -> &[Edit] {
        &self.edits
    }

    /// The edits that happen after so many iterations and before the next.
    pub fn before(&self, step: u64) -> &[Edit] {
        let first = self.edits.partition_point(|edit| edit.step < step);
        let end = self.edits.partition_point(|edit| edit.step <= step);
        &self.edits[first..end]
    }

    /// The first step, from `step` on, before which something happens.
    pub fn next_from(&self, step: u64) -> Option<u64> {
        self.edits.get(self.edits.partition_point(|edit| edit.step < step)).map(|edit| edit.step)
    }

    /// Reads a file. `materials` are the names of those that the ground is of.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that cannot be read, [`Error::Limit`] for one that is too long, else as
    /// [`Script::parse`].
    pub fn load(path: &Path, materials: &[&str]) -> Result<Self, Error> {
        let layout = Layout::of(path).map_err(|what| Error::input(path, what))?;
        let mut text = String::new();
        let reading =
            File::open(path).and_then(|file| file.take(MAX_BYTES as u64 + 1).read_to_string(&mut text));
        reading.map_err(|cause| Error::input(path, format!("cannot be read: {cause}")))?;
        Self::parse(&path.display().to_string(), &text, layout, materials)
    }

    /// Reads a text; `file` is its name for messages.
    ///
    /// # Errors
    /// [`Error::Recipe`] with all faults and their lines, [`Error::Limit`] for a text that is too long or has
    /// too many strokes.
    pub fn parse(file: &str, text: &str, layout: Layout, materials: &[&str]) -> Result<Self, Error> {
        check_length(file, text, layout)?;
        let mut diagnostics = Diagnostics::default();
        let tables = match layout {
            Layout::JsonLines => json_lines(text, &mut diagnostics),
            Layout::Toml => toml_tables(file, text, &mut diagnostics)?,
        };
        if tables.len() > MAX_STROKES {
            return Err(too_many(file, tables.len()));
        }
        let mut edits = Vec::with_capacity(tables.len());
        for table in &tables {
            edits.extend(keys::read(table, materials, &mut diagnostics));
            if diagnostics.found.len() >= MAX_FAULTS {
                break;
            }
        }
        if diagnostics.found.is_empty() {
            return Ok(Self::new(edits));
        }
        diagnostics.found.sort_by_key(|diagnostic| diagnostic.line);
        Err(RecipeError { file: file.to_owned(), diagnostics: diagnostics.found }.into())
    }

    /// The script as text, which reads as the same script.
    pub fn text(&self, layout: Layout) -> String {
        self.edits.iter().map(|edit| one(edit, layout)).collect()
    }

    /// Writes a file, whose extension chooses the layout.
    ///
    /// # Errors
    /// [`Error::Run`] for another extension or a failed write.
    pub fn save(&self, path: &Path) -> Result<(), Error> {
        let layout = Layout::of(path).map_err(Error::Run)?;
        write_whole(path, self.text(layout).as_bytes())
    }
}

fn one(edit: &Edit, layout: Layout) -> String {
    let keys = keys::written(edit).into_iter();
    match layout {
        Layout::JsonLines => {
            let keys: Vec<_> = keys.map(|(key, value)| format!("\"{key}\": {value}")).collect();
            format!("{{{}}}\n", keys.join(", "))
        }
        Layout::Toml => {
            let lines: Vec<_> = keys.map(|(key, value)| format!("{key} = {value}\n")).collect();
            format!("[[edit]]\n{}\n", lines.concat())
        }
    }
}

/// What can be known to be too much before any of it is kept.
fn check_length(file: &str, text: &str, layout: Layout) -> Result<(), Error> {
    let (most, remedy) = match layout {
        Layout::JsonLines => (MAX_BYTES, "leave out strokes, or points of their paths"),
        Layout::Toml => (source::MAX_BYTES, "JSON lines (.jsonl) may be longer"),
    };
    if text.len() > most {
        // A file is not read on beyond the longest script, so that its whole length is not known.
        let asked = Some(text.len() as u64).filter(|_| text.len() <= MAX_BYTES);
        let limit = Limit::new(Quantity::FileBytes, asked, 0..=most as u64);
        return Err(limit.of(format!("{file}: a script")).remedy(remedy).into());
    }
    let strokes = match layout {
        Layout::JsonLines => text.lines().filter(|line| !line.trim().is_empty()).count(),
        Layout::Toml => 0,
    };
    if strokes > MAX_STROKES { Err(too_many(file, strokes)) } else { Ok(()) }
}

fn too_many(file: &str, strokes: usize) -> Error {
    let limit = Limit::new(Quantity::Strokes, strokes as u64, 0..=MAX_STROKES as u64);
    limit.of(format!("{file}: a script")).remedy("leave out strokes").into()
}

fn toml_tables(file: &str, text: &str, diagnostics: &mut Diagnostics) -> Result<Vec<Table>, RecipeError> {
    let mut script = source::parse(file, text)?;
    diagnostics.unknown_keys(&script, &["edit"]);
    let Some(Node { line, value }) = script.take("edit") else { return Ok(Vec::new()) };
    let Value::List(items) = value else {
        let message = "`edit` is written with double brackets: [[edit]]".to_owned();
        return Err(RecipeError { file: file.to_owned(), diagnostics: vec![Diagnostic { line, message }] });
    };
    let mut tables = Vec::new();
    for Node { line, value } in items {
        match value {
            Value::Table(table) => tables.push(table),
            other => diagnostics.add(line, format!("`edit` holds {}; it is written [[edit]]", other.shown())),
        }
    }
    Ok(tables)
}
