//! What goes between a page and its worker, which share no memory: tasks and states as JSON, landscapes and surfaces as
//! bytes and numbers beside it.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use weald::edit::{Brush, Canvas, Change, Edit, Effect, Layout, Script, Setting};
use weald::engine::Engine;
use weald::grow::Vegetation;
use weald::recipe::{Overrides, Recipe, pack_landscape, unpack_landscape};
use weald::{Error, Field, Landscape, Size};

use super::status::{Shown, Status, Surface};
use super::task::{Opening, Task};

/// A file that has changed, with its bytes, or `None` for one that is gone.
pub type ChangedFile = (PathBuf, Option<Vec<u8>>);

/// What is sent at once: a text, and arrays in the order in which it speaks of them.
#[derive(Debug, Default)]
pub struct Parcel {
    /// JSON.
    pub text: String,
    /// What would be long in JSON.
    pub arrays: VecDeque<Array>,
}

/// An array beside a text.
#[derive(Debug, PartialEq)]
pub enum Array {
    /// Of bytes.
    Bytes(Vec<u8>),
    /// Of numbers.
    Singles(Vec<f32>),
}

type Arrays = VecDeque<Array>;

fn take_bytes(arrays: &mut Arrays) -> Result<Vec<u8>, Error> {
    match arrays.pop_front() {
        Some(Array::Bytes(bytes)) => Ok(bytes),
        other => Err(missing(other.as_ref())),
    }
}

fn take_singles(arrays: &mut Arrays) -> Result<Vec<f32>, Error> {
    match arrays.pop_front() {
        Some(Array::Singles(singles)) => Ok(singles),
        other => Err(missing(other.as_ref())),
    }
}

fn missing(found: Option<&Array>) -> Error {
    let found = found.map_or("none", |_| "one of another kind");
    Error::Run(format!("a message should have another array, and has {found}; load the page again"))
}

/// Files that have changed since the last message, and something else to say.
#[derive(Debug, Serialize, Deserialize)]
struct Envelope<T> {
    /// Paths, and whether the file is there; the bytes are the first of the arrays.
    files: Vec<(PathBuf, bool)>,
    content: T,
}

fn packed<T: Serialize>(files: Vec<ChangedFile>, content: T, arrays: Arrays) -> Parcel {
    let (mut named, mut all) = (Vec::new(), Arrays::new());
    for (path, bytes) in files {
        named.push((path, bytes.is_some()));
        all.extend(bytes.map(Array::Bytes));
    }
    all.extend(arrays);
    let text = serde_json::to_string(&Envelope { files: named, content });
    Parcel { text: text.expect("texts and finite numbers are JSON"), arrays: all }
}

fn unpacked<T: DeserializeOwned>(parcel: Parcel) -> Result<(Vec<ChangedFile>, T, Arrays), Error> {
    let Parcel { text, mut arrays } = parcel;
    let Envelope { files, content } = serde_json::from_str(&text).map_err(|cause| not_understood(&cause))?;
    let mut changed = Vec::new();
    for (path, is_there) in files {
        let bytes = is_there.then(|| take_bytes(&mut arrays)).transpose()?;
        changed.push((path, bytes));
    }
    Ok((changed, content, arrays))
}

/// A task as it is sent.
#[derive(Debug, Serialize, Deserialize)]
enum SentTask {
    Open { file: String, text: String, revision: u64, steps: Option<usize>, keeps_edits: bool },
    Play(bool),
    Advance(u64),
    PlayToEnd,
    Set(SentChange),
    Stroke { brush: SentChange, stroke: u64, replaces: bool },
    Undo,
    Redo,
    GoTo(usize),
    Name(String),
    Rename { from: String, to: String },
    Save(PathBuf),
    Keep(PathBuf),
    Export { folder: PathBuf, outputs: Option<String> },
    Seeds { folder: PathBuf, first: u64, count: u64 },
    EndSeeds,
    Close,
    End,
}

/// A change as a line of a script, and the material that it names.
#[derive(Debug, Serialize, Deserialize)]
struct SentChange {
    line: String,
    material: Option<String>,
}

impl SentChange {
    fn of(change: Change) -> Self {
        let material = match &change {
            Change::Stroke(Brush {
                effect: Effect::Add { material, .. } | Effect::Remove { material, .. },
                ..
            }) => Some(material.clone()),
            _ => None,
        };
        Self { line: Script::new(vec![Edit { step: 0, change }]).text(Layout::JsonLines), material }
    }

    fn read(self) -> Result<Change, Error> {
        let materials: Vec<_> = self.material.iter().map(String::as_str).collect();
        let script = Script::parse("a change", &self.line, Layout::JsonLines, &materials)?;
        let change = script.edits().first().map(|edit| edit.change.clone());
        change.ok_or_else(|| Error::Run("a change was sent without one".to_owned()))
    }

    fn brush(self) -> Result<Brush, Error> {
        match self.read()? {
            Change::Stroke(brush) => Ok(brush),
            Change::Set(_) => Err(Error::Run("a setting was sent for a stroke".to_owned())),
        }
    }

    fn setting(self) -> Result<Setting, Error> {
        match self.read()? {
            Change::Set(setting) => Ok(setting),
            Change::Stroke(_) => Err(Error::Run("a stroke was sent for a setting".to_owned())),
        }
    }
}

/// A task, or only files. Where simulations run is for the worker to know.
pub(super) fn parcel_of_task(files: Vec<ChangedFile>, task: Option<Task>) -> Parcel {
    packed(files, task.map(sent_task), Arrays::new())
}

fn sent_task(task: Task) -> SentTask {
    match task {
        Task::Open(opening) => {
            let Opening { file, text, revision, steps, keeps_edits, .. } = *opening;
            SentTask::Open { file, text, revision, steps, keeps_edits }
        }
        Task::Play(plays) => SentTask::Play(plays),
        Task::Advance(steps) => SentTask::Advance(steps),
        Task::PlayToEnd => SentTask::PlayToEnd,
        Task::Set(setting) => SentTask::Set(SentChange::of(Change::Set(setting))),
        Task::Stroke { brush, stroke, replaces } => {
            SentTask::Stroke { brush: SentChange::of(Change::Stroke(brush)), stroke, replaces }
        }
        Task::Undo => SentTask::Undo,
        Task::Redo => SentTask::Redo,
        Task::GoTo(moment) => SentTask::GoTo(moment),
        Task::Name(name) => SentTask::Name(name),
        Task::Rename { from, to } => SentTask::Rename { from, to },
        Task::Save(file) => SentTask::Save(file),
        Task::Keep(file) => SentTask::Keep(file),
        Task::Export { folder, outputs } => SentTask::Export { folder, outputs },
        Task::Seeds { folder, first, count } => SentTask::Seeds { folder, first, count },
        Task::EndSeeds => SentTask::EndSeeds,
        Task::Close => SentTask::Close,
        Task::End => SentTask::End,
    }
}

/// The files and the task of a message.
pub(super) fn task_of_parcel(
    parcel: Parcel,
    engine: &Engine,
) -> Result<(Vec<ChangedFile>, Option<Task>), Error> {
    let (files, sent, _) = unpacked::<Option<SentTask>>(parcel)?;
    Ok((files, sent.map(|sent| sent.read(engine)).transpose()?))
}

impl SentTask {
    fn read(self, engine: &Engine) -> Result<Task, Error> {
        Ok(match self {
            Self::Open { file, text, revision, steps, keeps_edits } => {
                let engine = engine.clone();
                Task::Open(Box::new(Opening { file, text, revision, engine, steps, keeps_edits }))
            }
            Self::Play(plays) => Task::Play(plays),
            Self::Advance(steps) => Task::Advance(steps),
            Self::PlayToEnd => Task::PlayToEnd,
            Self::Set(change) => Task::Set(change.setting()?),
            Self::Stroke { brush, stroke, replaces } => {
                Task::Stroke { brush: brush.brush()?, stroke, replaces }
            }
            Self::Undo => Task::Undo,
            Self::Redo => Task::Redo,
            Self::GoTo(moment) => Task::GoTo(moment),
            Self::Name(name) => Task::Name(name),
            Self::Rename { from, to } => Task::Rename { from, to },
            Self::Save(file) => Task::Save(file),
            Self::Keep(file) => Task::Keep(file),
            Self::Export { folder, outputs } => Task::Export { folder, outputs },
            Self::Seeds { folder, first, count } => Task::Seeds { folder, first, count },
            Self::EndSeeds => Task::EndSeeds,
            Self::Close => Task::Close,
            Self::End => Task::End,
        })
    }
}

fn not_understood(cause: &serde_json::Error) -> Error {
    Error::Run(format!("the page and its worker are of different versions: {cause}; load the page again"))
}

/// A state as it is sent: what it shows only where that is another than before.
#[derive(Debug, Serialize, Deserialize)]
struct SentStatus {
    status: Status,
    shown: Option<SentShown>,
    surface: Option<SentSurface>,
}

/// A landscape beside its bytes: its materials and fractals are those of the recipe.
#[derive(Debug, Serialize, Deserialize)]
struct SentShown {
    lowest: f32,
    number: u64,
    revision: u64,
    steps: usize,
    changes: u64,
    recipe: (String, String),
}

/// A surface beside its numbers.
#[derive(Debug, Serialize, Deserialize)]
struct SentSurface {
    first: [usize; 2],
    cell: f64,
    materials: Vec<String>,
    size: [usize; 2],
    number: u64,
    shown: u64,
}

/// What the other side has already: numbers of the landscape and of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Known {
    shown: u64,
    surface: (u64, u64),
}

/// A state, with what is not yet known.
pub(super) fn parcel_of_status(files: Vec<ChangedFile>, mut status: Status, known: &mut Known) -> Parcel {
    let mut arrays = Arrays::new();
    let shown = status.shown.take().filter(|shown| shown.number != known.shown);
    let shown = shown.map(|shown| {
        known.shown = shown.number;
        arrays.push_back(Array::Bytes(pack_landscape(&shown.landscape)));
        let Shown { lowest, number, revision, steps, changes, recipe, .. } = shown;
        SentShown { lowest, number, revision, steps, changes, recipe: (*recipe).clone() }
    });
    let surface = status.surface.take().filter(|surface| (surface.shown, surface.number) != known.surface);
    let surface = surface.map(|surface| {
        known.surface = (surface.shown, surface.number);
        put_surface(&surface, &mut arrays)
    });
    packed(files, SentStatus { status, shown, surface }, arrays)
}

fn put_surface(surface: &Surface, arrays: &mut Arrays) -> SentSurface {
    let Canvas { first, cell, materials, bedrock, thickness, water, source, rain, frozen, mask, .. } =
        &*surface.canvas;
    let around = [&*surface.ground, bedrock, water, source, rain, frozen, mask];
    for field in around.into_iter().chain(thickness) {
        arrays.push_back(Array::Singles(field.values().to_vec()));
    }
    let Size { columns, rows } = surface.ground.size();
    SentSurface {
        first: *first,
        cell: *cell,
        materials: materials.clone(),
        size: [columns, rows],
        number: surface.number,
        shown: surface.shown,
    }
}

/// Brings a state up to date with a message, and gives the files that have changed.
pub(super) fn take_status(parcel: Parcel, before: &mut Status) -> Result<Vec<ChangedFile>, Error> {
    let (files, SentStatus { mut status, shown, surface }, mut arrays) = unpacked(parcel)?;
    let arrays = &mut arrays;
    let is_new = shown.is_some();
    status.shown = match shown {
        Some(sent) => Some(take_shown(sent, arrays)?),
        None => before.shown.take(),
    };
    status.surface = match surface {
        Some(sent) => Some(take_surface(sent, status.shown.as_ref(), arrays)?),
        None if is_new => None,
        None => before.surface.take(),
    };
    *before = status;
    Ok(files)
}

fn take_shown(sent: SentShown, arrays: &mut Arrays) -> Result<Shown, Error> {
    let SentShown { lowest, number, revision, steps, changes, recipe } = sent;
    let landscape = dressed(unpack_landscape(&take_bytes(arrays)?)?, &recipe.0, &recipe.1)?;
    Ok(Shown {
        landscape: Arc::new(landscape),
        lowest,
        number,
        revision,
        steps,
        changes,
        recipe: Arc::new(recipe),
    })
}

/// A landscape with the materials and the fractals of its recipe.
fn dressed(mut landscape: Landscape, file: &str, text: &str) -> Result<Landscape, Error> {
    let recipe = Recipe::parse(file, text, &Overrides::default())?;
    landscape.materials = recipe.make_materials();
    landscape.set_fractals(recipe.make_fractals()?);
    Ok(landscape)
}

fn take_surface(sent: SentSurface, shown: Option<&Shown>, arrays: &mut Arrays) -> Result<Surface, Error> {
    let size = Size::new(sent.size[0], sent.size[1]).map_err(|cause| Error::Run(cause.to_string()))?;
    let mut next = || take_singles(arrays).map(|singles| Field::from_values(size, singles));
    let [ground, bedrock, water] = [next()?, next()?, next()?];
    let [source, rain, frozen, mask] = [next()?, next()?, next()?, next()?];
    let thickness = sent.materials.iter().skip(1).map(|_| next()).collect::<Result<_, _>>()?;
    let canvas = Canvas {
        first: sent.first,
        cell: sent.cell,
        materials: sent.materials,
        valid: shown.and_then(|shown| shown.landscape.domain.valid.clone()),
        bedrock,
        thickness,
        water,
        source,
        rain,
        frozen,
        mask,
    };
    Ok(Surface { ground: Arc::new(ground), canvas: Arc::new(canvas), number: sent.number, shown: sent.shown })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::edit::Area;
    use weald::material::Material;

    #[test]
    fn a_surface_that_is_known_is_not_sent_again() {
        let size = Size::square(4).expect("small");
        let canvas = Canvas::level(Area { first: [0, 0], size }, 10.0, &Material::default_stack());
        let ground = Arc::new(Field::filled(size, 1.0));
        let surface = Surface { ground, canvas: Arc::new(canvas), number: 3, shown: 2 };
        let status = Status { surface: Some(surface), ..Status::default() };
        let mut known = Known::default();
        let mut sent = || parcel_of_status(Vec::new(), status.clone(), &mut known).arrays.len();
        assert!(sent() > 5, "ground, bedrock, water and what lies on it");
        assert_eq!(sent(), 0);
    }
}
