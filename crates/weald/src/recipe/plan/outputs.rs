//! The `[[output]]` tables.

use std::path::{Component, Path, PathBuf};

use super::films::{self, Film, Motion};
use crate::recipe::plan::words::{Vocabulary, hint, tables};
use crate::recipe::{CHECKPOINT_FILE, REPORT_FILE};
use weald_core::parameter::{Diagnostics, LayerName, Legal, Parameter, check_file, read_key};
use weald_core::source::{Node, Table, Value};
use weald_export::{Export, ExportEntry};
use weald_io::{Capabilities, Encode};
use weald_picture::{Picture, PictureEntry, Render};

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
        encode: Encode,
        /// What of it the file holds.
        holds: Capabilities,
    },
    /// A picture.
    Picture {
        /// Its kind.
        name: &'static str,
        /// The picture, ready to be drawn.
        picture: Box<dyn Picture>,
    },
    /// Pictures in a row.
    Film {
        /// Their kind.
        name: &'static str,
        /// What each shows.
        picture: Box<dyn Picture>,
        /// How it moves.
        film: Film,
    },
    /// Files for other programs.
    Export {
        /// Its kind.
        name: &'static str,
        /// The export, ready to be written.
        export: Box<dyn Export>,
    },
}

impl Output {
    /// Whether it is a film with a video.
    pub fn is_video(&self) -> bool {
        matches!(self.content, Content::Film { .. }) && Film::is_video(&self.file)
    }

    /// Whether it is a time-lapse of the simulations.
    pub fn lapses(&self) -> bool {
        matches!(&self.content, Content::Film { film: Film { motion: Motion::TimeLapse(_), .. }, .. })
    }

    /// The picture that a device draws, where it is one.
    pub fn render(&self) -> Option<&Render> {
        match &self.content {
            Content::Picture { picture, .. } | Content::Film { picture, .. } => picture.as_render(),
            _ => None,
        }
    }

    /// Names of the layers that it needs.
    pub fn reads(&self) -> Vec<String> {
        match &self.content {
            Content::Layer { name, .. } => vec![name.clone()],
            Content::Picture { picture, .. } | Content::Film { picture, .. } => picture.reads(),
            Content::Export { export, .. } => export.reads(),
        }
    }

    /// Names of the plants that it needs.
    pub fn plants(&self) -> Vec<String> {
        match &self.content {
            Content::Export { export, .. } => export.plants(),
            _ => Vec::new(),
        }
    }

    /// Names of the grass that it needs.
    pub fn meadows(&self) -> Vec<String> {
        match &self.content {
            Content::Export { export, .. } => export.meadows(),
            _ => Vec::new(),
        }
    }
}

impl Output {
    /// Names of the fractals that it shows.
    pub fn fractals(&self) -> Vec<String> {
        match &self.content {
            Content::Picture { picture, .. } | Content::Film { picture, .. } => picture.fractals(),
            Content::Export { export, .. } => export.fractals(),
            Content::Layer { .. } => Vec::new(),
        }
    }

    /// Whether it shows fractals and nothing of a landscape.
    pub fn needs_no_ground(&self) -> bool {
        self.reads().is_empty() && !self.fractals().is_empty()
    }
}

pub(super) fn read(vocabulary: &Vocabulary, recipe: &Table, diagnostics: &mut Diagnostics) -> Vec<Output> {
    "output".clone_into(&mut diagnostics.subject);
    let mut outputs: Vec<Output> = Vec::new();
    for table in tables(recipe, "output", diagnostics) {
        let Some(file) = file_of(table, diagnostics) else { continue };
        if let Some(earlier) = outputs.iter().find(|earlier| same_file(&earlier.file, &file)) {
            let shown = file.display();
            let message = format!("`file` is {shown} a second time; line {} has it first", earlier.line);
            diagnostics.add(line_of(table, "file"), message);
        }
        if let Some(content) = content_of(vocabulary, table, &file, diagnostics) {
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
fn file_of(table: &Table, diagnostics: &mut Diagnostics) -> Option<PathBuf> {
    let (text, line) = match table.get("file") {
        Some(Node { value: Value::Text(text), line }) => (text, *line),
        Some(Node { value, line }) => {
            diagnostics.add(*line, format!("`file` is {}, but must be a file name", value.shown()));
            return None;
        }
        None => {
            diagnostics.add(table.line, "`file` is needed: the name of a file in the output folder");
            return None;
        }
    };
    let inside = inside(Path::new(text));
    match &inside {
        None => {
            let message =
                format!("`file` is {text:?}; it must be a name inside the output folder, without ..");
            diagnostics.add(line, message);
        }
        Some(path) if [REPORT_FILE, CHECKPOINT_FILE].map(Path::new).contains(&path.as_path()) => {
            diagnostics.add(line, format!("`file` is {text:?}, a name that every run uses itself"));
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
    diagnostics: &mut Diagnostics,
) -> Option<Content> {
    let named: Vec<_> = CONTENTS.iter().filter_map(|key| Some((*key, table.get(key)?))).collect();
    match named.as_slice() {
        [("layer", _)] => layer(vocabulary, table, file, diagnostics),
        [("picture", node)] => {
            let entry = entry_of("picture", node, (vocabulary.pictures, |entry| entry.name), diagnostics)?;
            Some(picture(entry, table, file, diagnostics))
        }
        [("export", node)] => {
            let entry = entry_of("export", node, (vocabulary.exports, |entry| entry.name), diagnostics)?;
            Some(export(entry, table, file, diagnostics))
        }
        [(first, _), (second, node), ..] => {
            let message = format!(
                "`{first}` and `{second}` exclude each other; pictures and exports say `of` which layer they are"
            );
            diagnostics.add(node.line, message);
            None
        }
        _ => {
            diagnostics.unknown_keys(table, &["layer", "picture", "export", "file"]);
            diagnostics.add(table.line, "`layer`, `picture` or `export` is needed: what the file shows");
            None
        }
    }
}

/// Keys of which an output has one.
const CONTENTS: [&str; 3] = ["layer", "picture", "export"];

fn layer(
    vocabulary: &Vocabulary,
    table: &Table,
    file: &Path,
    diagnostics: &mut Diagnostics,
) -> Option<Content> {
    let before = diagnostics.found.len();
    diagnostics.unknown_keys(table, &["layer", "file", "preset"]);
    let name = read_key(table, "layer", LayerName::needed(), Legal::ANY, diagnostics).0;
    let preset: Option<String> = read_key(table, "preset", None, Legal::ANY, diagnostics);
    let format = match (vocabulary.format_of)(file) {
        Ok(format) => format,
        Err(problem) => {
            diagnostics.add(line_of(table, "file"), format!("`file`: {problem}"));
            return None;
        }
    };
    match format.writing(preset.as_deref()) {
        Ok((encode, holds)) => {
            (diagnostics.found.len() == before).then_some(Content::Layer { name, encode, holds })
        }
        Err(problem) => {
            let key = if preset.is_some() { "preset" } else { "file" };
            diagnostics.add(line_of(table, key), format!("`{key}`: {problem}"));
            None
        }
    }
}

fn picture(entry: &PictureEntry, table: &Table, file: &Path, diagnostics: &mut Diagnostics) -> Content {
    let (whole, mut table) = (table, table.clone());
    entry.name.clone_into(&mut diagnostics.subject);
    let film = films::take(&mut table, diagnostics);
    let (what, extensions) =
        if film.is_some() { ("a film", films::EXTENSIONS) } else { ("a picture", entry.extensions) };
    ensure_extension(&table, file, (what, extensions), diagnostics);
    let picture = with_keys(("picture", entry.name), &table, diagnostics, (entry.parameters, entry.read));
    if let Some((line, fault)) = films::fault(film.as_ref(), (entry.name, whole), picture.as_ref()) {
        diagnostics.add(line, fault);
    }
    match film {
        Some(film) => Content::Film { name: entry.name, picture, film },
        None => Content::Picture { name: entry.name, picture },
    }
}

fn export(entry: &ExportEntry, table: &Table, file: &Path, diagnostics: &mut Diagnostics) -> Content {
    let what = format!("export = {:?}", entry.name);
    ensure_extension(table, file, (&what, entry.extensions), diagnostics);
    let export = with_keys(("export", entry.name), table, diagnostics, (entry.parameters, entry.read));
    for fault in export.faults() {
        diagnostics.add(table.line_of(&fault.key), fault);
    }
    if let Some(problem) = export.left_out(file) {
        diagnostics.add(line_of(table, "file"), format!("`file`: {problem}"));
    }
    Content::Export { name: entry.name, export }
}

/// The entry whose name stands under `key`, where it is a known one.
fn entry_of<T>(
    key: &str,
    node: &Node,
    (entries, name_of): (&'static [T], fn(&T) -> &'static str),
    diagnostics: &mut Diagnostics,
) -> Option<&'static T> {
    let Value::Text(name) = &node.value else {
        diagnostics.add(node.line, format!("`{key}` is {}, but must be text", node.value.shown()));
        return None;
    };
    let entry = entries.iter().find(|entry| name_of(entry) == name);
    if entry.is_none() {
        let known: Vec<_> = entries.iter().map(name_of).collect();
        diagnostics.add(node.line, format!("there is no {key} {name:?}; {}", hint(name, &known)));
    }
    entry
}

fn ensure_extension(
    table: &Table,
    file: &Path,
    (what, extensions): (&str, &[&str]),
    diagnostics: &mut Diagnostics,
) {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    if !extensions.iter().any(|known| extension.eq_ignore_ascii_case(known)) {
        let known = extensions.join(" or .");
        let message = format!("`file` is {}; {what} writes .{known}", file.display());
        diagnostics.add(line_of(table, "file"), message);
    }
}

/// Reads a kind of output from its keys.
type Reader<T> = fn(&Table, &mut Diagnostics) -> T;

/// Reads the keys of a picture or an export: all but its kind and its file.
fn with_keys<T>(
    (key, subject): (&str, &str),
    table: &Table,
    diagnostics: &mut Diagnostics,
    (parameters, read): (fn() -> Vec<Parameter>, Reader<T>),
) -> T {
    let mut keys = table.clone();
    keys.take(key);
    keys.take("file");
    subject.clone_into(&mut diagnostics.subject);
    check_file(table, &parameters(), diagnostics);
    let read = read(&keys, diagnostics);
    "output".clone_into(&mut diagnostics.subject);
    read
}
