//! What a landscape becomes outside: pictures, files, strokes.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use weald::edit::{Brush, Change, Layout, Script};
use weald::error::Error;
use weald::export::{EXPORTS, Export, Finished};
use weald::io::write_parts;
use weald::picture::{Frame, PICTURES, Picture};
use weald::recipe::Frames;
use weald::recipe::source::{Node, Table, Value};
use weald::{Landscape, layer_words};

use crate::calls::checked;
use crate::engines::drawing;
use crate::errors::{exception, usage};
use crate::values;
use crate::watch::Line;

/// The picture of that kind with its keys.
pub(crate) fn picture(kind: &str, keys: &Bound<'_, PyDict>) -> PyResult<Box<dyn Picture>> {
    let py = keys.py();
    let Some(entry) = PICTURES.iter().find(|entry| entry.name == kind) else {
        let known: Vec<_> = PICTURES.iter().map(|entry| entry.name).collect();
        return Err(usage(py, format!("there is no picture `{kind}`; there are: {}", known.join(", "))));
    };
    let table = values::table(keys)?;
    checked(py, kind, |diagnostics| (entry.read)(&table, diagnostics))
}

/// The export of that kind with its keys.
pub(crate) fn export(kind: &str, keys: &Bound<'_, PyDict>) -> PyResult<Box<dyn Export>> {
    let py = keys.py();
    let Some(entry) = EXPORTS.iter().find(|entry| entry.name == kind) else {
        let known: Vec<_> = EXPORTS.iter().map(|entry| entry.name).collect();
        return Err(usage(py, format!("there is no export `{kind}`; there are: {}", known.join(", "))));
    };
    let table = values::table(keys)?;
    let export = checked(py, kind, |diagnostics| (entry.read)(&table, diagnostics))?;
    let faults: Vec<_> = export.faults().iter().map(ToString::to_string).collect();
    if faults.is_empty() { Ok(export) } else { Err(usage(py, faults.join("; "))) }
}

/// The bytes of a picture: PNG or SVG.
pub(crate) fn drawn(
    picture: &dyn Picture,
    landscape: &Landscape,
    svg: bool,
    line: &Line,
) -> Result<Vec<u8>, Error> {
    picture.reads().iter().try_for_each(|name| needed(landscape, name))?;
    picture.check_on(&landscape.domain)?;
    if svg {
        return picture.svg(landscape).map(String::into_bytes);
    }
    let text = [("Software".to_owned(), format!("Weald {}", env!("CARGO_PKG_VERSION")))];
    if let Some(render) = picture.as_render() {
        let device = drawing();
        render.check(&*device)?;
        let frames = render.frame_sequence(landscape, &*device)?;
        let image = frames.set_up()?.draw(&frames.camera(Frame::STILL), Frame::STILL.seconds)?;
        return Ok(image.to_png(&text));
    }
    Ok(picture.cutout(landscape, &mut |_, _| going_on(line))?.to_png(&text))
}

/// The bytes of an animated PNG, of so many frames, so many a second.
pub(crate) fn film(
    picture: &dyn Picture,
    landscape: &Landscape,
    (count, per_second): (u64, f64),
    line: &Line,
) -> Result<Vec<u8>, Error> {
    picture.reads().iter().try_for_each(|name| needed(landscape, name))?;
    picture.check_on(&landscape.domain)?;
    let seconds = count as f64 / per_second;
    if picture.turned(0.0, seconds).is_none() {
        return Err(Error::Run("this picture does not move; `view` and `fractal` do".to_owned()));
    }
    let mut draw = |number: u64| {
        line.at(number, count, 0);
        let turned = picture.turned(number as f64 / count as f64, seconds);
        turned.expect("it moves").cutout(landscape, &mut |_, _| going_on(line))
    };
    in_file("film.apng", |path| {
        Frames { count, per_second, text: &[] }.write(path, &mut draw)?;
        std::fs::read(path).map_err(|cause| Error::input(path, cause.to_string()))
    })
}

fn going_on(line: &Line) -> Result<(), Error> {
    if line.is_cancelled() { Err(Error::Interrupted("interrupted".to_owned())) } else { Ok(()) }
}

/// Works with a file in a folder that is gone afterwards.
pub(crate) fn in_file<T>(name: &str, work: impl FnOnce(&Path) -> Result<T, Error>) -> Result<T, Error> {
    let unmade = |cause: std::io::Error| Error::Run(format!("no temporary folder can be made: {cause}"));
    let folder = tempfile::tempdir().map_err(unmade)?;
    work(&folder.path().join(name))
}

/// Writes the files of an export.
pub(crate) fn written(
    export: &dyn Export,
    landscape: &Landscape,
    path: &Path,
) -> Result<(Vec<PathBuf>, Vec<String>), Error> {
    export.reads().iter().try_for_each(|name| needed(landscape, name))?;
    export.plants().iter().try_for_each(|name| landscape.plants(name).map(drop))?;
    export.check_on(&landscape.domain, path)?;
    let finished = Finished { landscape, steps: &[], recipe: "", hash: "", seed: 0 };
    let parts = export.parts(&finished, path)?;
    write_parts(path, &parts)?;
    let names = parts.iter().map(|part| part.name.path(path)).collect();
    Ok((names, export.notes(&finished)))
}

fn needed(landscape: &Landscape, name: &str) -> Result<(), Error> {
    landscape.layer(name).map(drop).map_err(|error| match layer_words::meaning(name) {
        None => error,
        Some(meaning) => Error::Run(format!("{error}; it is {meaning}")),
    })
}

/// A stroke of these keys.
pub(crate) fn brush(keys: &Bound<'_, PyDict>, materials: &[String]) -> PyResult<Brush> {
    match change(keys, materials)? {
        Change::Stroke(brush) => Ok(brush),
        Change::Set(_) => Err(usage(keys.py(), "a landscape at rest has no keys to be set; a session has")),
    }
}

/// A stroke or a setting of these keys, as a script has them.
pub(crate) fn change(keys: &Bound<'_, PyDict>, materials: &[String]) -> PyResult<Change> {
    let text = json(&Value::Table(values::table(keys)?)).to_string();
    let materials: Vec<_> = materials.iter().map(String::as_str).collect();
    let script = Script::parse("paint", &text, Layout::JsonLines, &materials);
    let script = script.map_err(|error| exception(keys.py(), error))?;
    Ok(script.edits()[0].change.clone())
}

fn json(value: &Value) -> serde_json::Value {
    match value {
        Value::Flag(flag) => (*flag).into(),
        Value::Integer(number) => (*number).into(),
        Value::Number(number) => (*number).into(),
        Value::Text(text) => text.as_str().into(),
        Value::List(items) => items.iter().map(|Node { value, .. }| json(value)).collect(),
        Value::Table(Table { entries, .. }) => {
            entries.iter().map(|(key, node)| (key.clone(), json(&node.value))).collect()
        }
    }
}
