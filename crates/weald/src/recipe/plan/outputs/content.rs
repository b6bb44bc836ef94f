//! What an `[[output]]` shows: a layer, a picture or an export, each with its own keys.

use std::path::Path;

use crate::recipe::layer_output::Treatment;
use crate::recipe::plan::films::{self, Film, FilmKeys, Moves};
use crate::recipe::plan::treatments;
use crate::recipe::plan::unknown_keys::{self, KindOfOutput};
use crate::recipe::plan::words::{Vocabulary, hint};
use weald_core::parameter::{Diagnostics, LayerName, Legal, Parameter, Parameters, check_file, read_key};
use weald_core::source::{Node, Table, Value};
use weald_export::{Export, ExportEntry};
use weald_io::{Capabilities, Encode};
use weald_picture::{Picture, PictureEntry};

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
        /// What is done to it before.
        treatment: Treatment,
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

/// What the file of a table shows; `None` where that is told as a fault.
pub(super) fn content_of(
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
            Some(picture(vocabulary, entry, (table, file), diagnostics))
        }
        [("export", node)] => {
            let entry = entry_of("export", node, (vocabulary.exports, |entry| entry.name), diagnostics)?;
            Some(export(vocabulary, entry, (table, file), diagnostics))
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

/// Line of a key, or of its table where it is left out.
pub(super) fn line_of(table: &Table, key: &str) -> usize {
    table.get(key).map_or(table.line, |node| node.line)
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
    diagnostics.unknown_keys(table, &["layer", "file", "preset", "grid", "resampling", "codes"]);
    let name = read_key(table, "layer", LayerName::needed(), Legal::ANY, diagnostics).0;
    let preset: Option<String> = read_key(table, "preset", None, Legal::ANY, diagnostics);
    let treatment = treatments::read(table, &name, diagnostics);
    let format = match (vocabulary.format_of)(file) {
        Ok(format) => format,
        Err(problem) => {
            diagnostics.add(line_of(table, "file"), format!("`file`: {problem}"));
            return None;
        }
    };
    match format.writing(preset.as_deref()) {
        Ok((encode, holds)) => {
            (diagnostics.found.len() == before).then_some(Content::Layer { name, encode, holds, treatment })
        }
        Err(problem) => {
            let key = if preset.is_some() { "preset" } else { "file" };
            diagnostics.add(line_of(table, key), format!("`{key}`: {problem}"));
            None
        }
    }
}

fn picture(
    vocabulary: &Vocabulary,
    entry: &PictureEntry,
    (whole, file): (&Table, &Path),
    diagnostics: &mut Diagnostics,
) -> Content {
    let mut table = whole.clone();
    entry.name.clone_into(&mut diagnostics.subject);
    let moves = films::take(&mut table, diagnostics);
    let mut known = (entry.parameters)();
    known.extend(FilmKeys::parameters());
    let others = vocabulary.pictures.iter().map(|other| (other.name, other.parameters));
    let kind = KindOfOutput { key: "picture", known, others: others.collect() };
    unknown_keys::take_unknown(&kind, &mut table, diagnostics);
    let picture = with_keys(("picture", entry.name), &table, diagnostics, (entry.parameters, entry.read));
    let film = match moves {
        Some(Moves::Film(film)) => Some(film),
        _ => None,
    };
    if moves.is_some() {
        let missing = || films::missing_keys(file, picture.as_ref());
        let file_fault = match film {
            Some(_) => wrong_extension(file, "a film", films::EXTENSIONS),
            None => wrong_extension(file, &format!("picture = {:?}", entry.name), entry.extensions)
                .map(|fault| missing().unwrap_or(fault)),
        };
        let file_fault = file_fault.map(|fault| (line_of(&table, "file"), fault));
        let film_fault = films::fault(film.as_ref(), (entry.name, whole), picture.as_ref());
        for (line, fault) in file_fault.into_iter().chain(film_fault) {
            diagnostics.add(line, fault);
        }
    }
    match film {
        Some(film) => Content::Film { name: entry.name, picture, film },
        None => Content::Picture { name: entry.name, picture },
    }
}

fn export(
    vocabulary: &Vocabulary,
    entry: &ExportEntry,
    (whole, file): (&Table, &Path),
    diagnostics: &mut Diagnostics,
) -> Content {
    let table = &mut whole.clone();
    entry.name.clone_into(&mut diagnostics.subject);
    let others = vocabulary.exports.iter().map(|other| (other.name, other.parameters)).collect();
    unknown_keys::take_unknown(
        &KindOfOutput { key: "export", known: (entry.parameters)(), others },
        table,
        diagnostics,
    );
    "output".clone_into(&mut diagnostics.subject);
    let what = format!("export = {:?}", entry.name);
    if let Some(fault) = wrong_extension(file, &what, entry.extensions) {
        diagnostics.add(line_of(table, "file"), fault);
    }
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

/// Other formats of meshes, which are asked for in vain.
const OTHER_MESHES: [&str; 7] = ["gltf", "fbx", "obj", "usd", "usda", "usdc", "usdz"];

/// What is wrong with the name of a file, where it has none of the extensions.
fn wrong_extension(file: &Path, what: &str, extensions: &[&str]) -> Option<String> {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let is = |known: &&str| extension.eq_ignore_ascii_case(known);
    if extensions.iter().any(is) {
        return None;
    }
    let is_other_mesh = OTHER_MESHES.iter().any(is) && extensions.contains(&"glb");
    let hint =
        is_other_mesh.then_some("; of meshes only binary glTF is written, which Blender and engines import");
    let hint = hint.unwrap_or_default();
    let known = extensions.join(" or .");
    Some(format!("`file` is {}; {what} is written as .{known}{hint}", file.display()))
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
