//! The `[[output]]` tables.

use std::path::{Component, Path, PathBuf};

use super::{Vocabulary, hint, tables};
use crate::io::Format;
use crate::picture::Picture;
use crate::recipe::parameter::{Complaints, LayerName, read_key};
use crate::recipe::source::{Node, Table, Value};
use crate::recipe::{CHECKPOINT_FILE, REPORT_FILE};

/// A file that a run writes.
#[derive(Debug)]
pub struct Output {
    /// Line of its table.
    pub line: usize,
    /// Path inside the output folder.
    pub file: PathBuf,
    /// What is in it.
    pub content: Content,
}

/// What an output shows.
#[derive(Debug)]
pub enum Content {
    /// The values of a layer.
    Layer {
        /// Its name.
        name: String,
        /// How it is written.
        format: &'static Format,
    },
    /// A picture.
    Picture {
        /// Its kind.
        name: &'static str,
        /// The picture, ready to be drawn.
        picture: Box<dyn Picture>,
    },
}

impl Output {
    /// Names of the layers that it needs.
    pub fn reads(&self) -> Vec<String> {
        match &self.content {
            Content::Layer { name, .. } => vec![name.clone()],
            Content::Picture { picture, .. } => picture.reads(),
        }
    }
}

pub(super) fn read(vocabulary: &Vocabulary, recipe: &Table, complaints: &mut Complaints) -> Vec<Output> {
    "output".clone_into(&mut complaints.subject);
    let mut outputs: Vec<Output> = Vec::new();
    for table in tables(recipe, "output", complaints) {
        let Some(file) = file_of(table, complaints) else { continue };
        if let Some(earlier) = outputs.iter().find(|earlier| same_file(&earlier.file, &file)) {
            let shown = file.display();
            let message = format!("`file` is {shown} a second time; line {} has it first", earlier.line);
            complaints.add(line_of(table, "file"), message);
        }
        if let Some(content) = content_of(vocabulary, table, &file, complaints) {
            outputs.push(Output { line: table.line, file, content });
        }
    }
    outputs
}

/// Whether two names would be one file, also where a file system does not tell `A` from `a`.
fn same_file(a: &Path, b: &Path) -> bool {
    let lower = |path: &Path| path.to_string_lossy().to_lowercase();
    lower(a) == lower(b)
}

fn line_of(table: &Table, key: &str) -> usize {
    table.get(key).map_or(table.line, |node| node.line)
}

/// The file name, which must stay inside the output folder.
fn file_of(table: &Table, complaints: &mut Complaints) -> Option<PathBuf> {
    let (text, line) = match table.get("file") {
        Some(Node { value: Value::Text(text), line }) => (text, *line),
        Some(Node { value, line }) => {
            complaints.add(*line, format!("`file` is {}, but must be a file name", value.shown()));
            return None;
        }
        None => {
            complaints.add(table.line, "`file` is needed: the name of a file in the output folder");
            return None;
        }
    };
    let inside = inside(Path::new(text));
    match &inside {
        None => {
            let message =
                format!("`file` is {text:?}; it must be a name inside the output folder, without ..");
            complaints.add(line, message);
        }
        Some(path) if [REPORT_FILE, CHECKPOINT_FILE].map(Path::new).contains(&path.as_path()) => {
            complaints.add(line, format!("`file` is {text:?}, a name that every run uses itself"));
        }
        Some(_) => return inside,
    }
    None
}

/// The path without `.`; `None` where it leads out of its folder or names no file.
fn inside(path: &Path) -> Option<PathBuf> {
    let mut inside = PathBuf::new();
    for component in path.components() {
        match component {
            Component::Normal(name) => inside.push(name),
            Component::CurDir => {}
            _ => return None,
        }
    }
    let text = path.to_str()?;
    let names_a_file = !text.ends_with(['/', '\\']) && !text.contains('\0');
    (inside.file_name().is_some() && names_a_file).then_some(inside)
}

fn content_of(
    vocabulary: &Vocabulary,
    table: &Table,
    file: &Path,
    complaints: &mut Complaints,
) -> Option<Content> {
    match (table.get("layer"), table.get("picture")) {
        (Some(_), None) => layer(vocabulary, table, file, complaints),
        (None, Some(node)) => picture(vocabulary, table, node, file, complaints),
        (Some(_), Some(node)) => {
            complaints.add(
                node.line,
                "`layer` and `picture` exclude each other; a picture says `of` which layer it is",
            );
            None
        }
        (None, None) => {
            complaints.unknown_keys(table, &["layer", "picture", "file"]);
            complaints.add(table.line, "`layer` or `picture` is needed: what the file shows");
            None
        }
    }
}

fn layer(
    vocabulary: &Vocabulary,
    table: &Table,
    file: &Path,
    complaints: &mut Complaints,
) -> Option<Content> {
    let before = complaints.found.len();
    complaints.unknown_keys(table, &["layer", "file"]);
    let range = (f64::NEG_INFINITY, f64::INFINITY);
    let name = read_key(table, "layer", LayerName::needed(), range, complaints).0;
    let format = (vocabulary.format_of)(file).and_then(|format| match format.encode {
        Some(_) => Ok(format),
        None => Err(format!("{} is read, not written", format.name)),
    });
    match format {
        Ok(format) => (complaints.found.len() == before).then_some(Content::Layer { name, format }),
        Err(problem) => {
            complaints.add(line_of(table, "file"), format!("`file`: {problem}"));
            None
        }
    }
}

fn picture(
    vocabulary: &Vocabulary,
    table: &Table,
    kind: &Node,
    file: &Path,
    complaints: &mut Complaints,
) -> Option<Content> {
    let known: Vec<_> = vocabulary.pictures.iter().map(|entry| entry.name).collect();
    let Value::Text(name) = &kind.value else {
        complaints.add(kind.line, format!("`picture` is {}, but must be text", kind.value.shown()));
        return None;
    };
    let Some(entry) = vocabulary.pictures.iter().find(|entry| entry.name == name) else {
        complaints.add(kind.line, format!("there is no picture {name:?}; {}", hint(name, &known)));
        return None;
    };
    if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        let message = format!("`file` is {}; a picture is a .png", file.display());
        complaints.add(line_of(table, "file"), message);
    }
    let mut keys = table.clone();
    keys.take("picture");
    keys.take("file");
    entry.name.clone_into(&mut complaints.subject);
    let picture = (entry.read)(&keys, complaints);
    "output".clone_into(&mut complaints.subject);
    Some(Content::Picture { name: entry.name, picture })
}
