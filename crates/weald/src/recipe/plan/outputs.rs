//! The `[[output]]` tables.

mod content;

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use super::films::{Film, Motion};
use super::treatments;
use crate::recipe::layer_output::{OutputGrid, Treatment};
use crate::recipe::plan::words::{Vocabulary, tables};
use crate::recipe::{CHECKPOINT_FILE, REPORT_FILE};
pub use content::Content;
use content::{content_of, line_of};
use weald_core::parameter::{Diagnostics, LayerName};
use weald_core::source::{Node, Table, Value};
use weald_io::Resampling;
use weald_land::flow::DirectionCodes;
use weald_picture::Render;

weald_core::parameters! {
    /// The keys of an `[[output]]`, beside those of its picture or export.
    pub struct OutputKeys {
        /// Name in the output folder; the extension chooses the format.
        file: String = String::new();
        /// The layer that is written. An output has one of `layer`, `picture` and `export`.
        layer: Option<LayerName> = None;
        /// The kind of picture that is drawn.
        picture: Option<String> = None;
        /// The kind of export that is written.
        export: Option<String> = None;
        /// Write a layer as one reader wants it: `blender` (.exr with channels R, G and B, since Blender shows others as
        /// black), `terrain3d` (.exr with one channel R of floats, as Godot loads), `hterrain` (.exr with one channel R of
        /// half floats, as Zylann's HTerrain for Godot loads), `landlab` (.nc or .zarr with landlab's names, rows from
        /// the south), `sharded` (.zarr with up to 64 chunks in a file, for large grids), `cog` (.tif that is
        /// cloud-optimized, with smaller images for programs that show it from afar).
        preset: Option<String> = None, with layer;
        /// Grid on which a layer is written: that of the landscape, in square cells of metres, or that of the file from
        /// which the ground came, with its size, origin, cells and CRS.
        grid: OutputGrid = OutputGrid::Landscape, with layer;
        /// How a layer comes to the grid of its source. Without it measures do linearly, rivers and upslope areas with their
        /// greatest value, so that no river breaks, and numbers of things as the nearest cell has them. The file and the
        /// report say which.
        resampling: Option<Resampling> = None, when grid = "source";
        /// Whose numbers the layer `flow_direction` has; without it Weald's own, 1 east and on clockwise to 8 north-east.
        codes: Option<DirectionCodes> = None, with layer;
    }
}

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

    /// What is done to its layer before it is written.
    pub fn treatment(&self) -> Treatment {
        match self.content {
            Content::Layer { treatment, .. } => treatment,
            _ => Treatment::default(),
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
    let (mut outputs, mut lines) = (Vec::new(), BTreeMap::new());
    for table in tables(recipe, "output", diagnostics) {
        let Some(file) = file_of(table, diagnostics) else { continue };
        if let Some(first) = lines.get(&lower(&file)) {
            let shown = file.display();
            let message = format!("`file` is {shown} a second time; line {first} has it first");
            diagnostics.add(line_of(table, "file"), message);
        }
        if let Some(content) = content_of(vocabulary, table, &file, diagnostics) {
            if let Content::Layer { treatment, .. } = &content {
                treatments::check_source(*treatment, recipe, table, diagnostics);
            }
            lines.entry(lower(&file)).or_insert(table.line);
            outputs.push(Output { line: table.line, file, content });
        }
    }
    outputs
}

/// Whether two names would be one file, also where a file system does not tell `A` from `a`.
pub(super) fn same_file(a: &Path, b: &Path) -> bool {
    lower(a) == lower(b)
}

/// A path as file systems compare it that do not tell `A` from `a`.
pub(super) fn lower(path: &Path) -> PathBuf {
    PathBuf::from(path.to_string_lossy().to_lowercase())
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
