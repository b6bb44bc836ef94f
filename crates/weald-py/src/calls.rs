//! A step of the catalogue, read from the keywords of a call and run.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use weald::engine::{Engine, Job};
use weald::error::{Error, RecipeError};
use weald::recipe::catalog;
use weald::recipe::parameter::{Diagnostics, Fault};
use weald::step::{Entry, Layered, Outcome, Step};
use weald::{Landscape, material, sea};

use crate::errors::{exception, usage};
use crate::values;
use crate::watch::Line;

/// The step of that name.
pub(crate) fn entry(py: Python<'_>, name: &str) -> PyResult<&'static Entry> {
    catalog::find(name).ok_or_else(|| usage(py, format!("there is no step `{name}`")))
}

/// Reads the keys of a step; all faults come at once.
pub(crate) fn step(entry: &Entry, keys: &Bound<'_, PyDict>) -> PyResult<Box<dyn Step>> {
    let table = values::table(keys)?;
    let read = |diagnostics: &mut Diagnostics| (entry.read)(&table, diagnostics);
    let step = checked(keys.py(), entry.name, read)?;
    let faults = step.faults();
    let lines = faults.iter().map(Fault::to_string).collect();
    if faults.is_empty() { Ok(step) } else { Err(exception(keys.py(), recipe_error(entry.name, lines))) }
}

/// What is read from a table, unless there are faults.
pub(crate) fn checked<T>(
    py: Python<'_>,
    name: &str,
    read: impl FnOnce(&mut Diagnostics) -> T,
) -> PyResult<T> {
    let mut diagnostics = Diagnostics::default();
    let result = read(&mut diagnostics);
    if diagnostics.found.is_empty() {
        return Ok(result);
    }
    let lines = diagnostics.found.into_iter().map(|fault| fault.message).collect();
    Err(exception(py, recipe_error(name, lines)))
}

fn recipe_error(name: &str, messages: Vec<String>) -> Error {
    let of_call = |message| weald::error::Diagnostic { line: 0, message };
    RecipeError { file: name.to_owned(), diagnostics: messages.into_iter().map(of_call).collect() }.into()
}

/// Runs a step as `LandscapeExt::run_with` does, on an engine and before the eyes of a caller.
pub(crate) fn run(
    step: &dyn Step,
    landscape: &mut Landscape,
    (seed, engine): (u64, Engine),
    line: &Line,
) -> Result<Outcome, Error> {
    let faults: Vec<_> = step.faults_among(&landscape.materials).iter().map(Fault::to_string).collect();
    if !faults.is_empty() {
        return Err(Error::Run(format!("the step cannot run: {}", faults.join("; "))));
    }
    step.reads().iter().try_for_each(|name| landscape.layer(name).map(drop))?;
    step.check_on(&landscape.domain)?;
    step.look_ahead(&landscape.materials, &landscape.domain)?;
    let job = Job { seed, engine, watcher: line, resume: None };
    let outcome = step.run(landscape, &job)?;
    if line.is_cancelled() {
        return Err(Error::Interrupted("interrupted".to_owned()));
    }
    check_written(step, landscape)?;
    sea::stand(landscape)?;
    Ok(outcome)
}

/// What a step wrote holds numbers.
fn check_written(step: &dyn Step, landscape: &Landscape) -> Result<(), Error> {
    let valid = landscape.domain.valid.as_ref();
    for name in written(step, landscape) {
        if let Some((x, y)) = landscape.field(&name)?.first_not_finite(valid) {
            let value = landscape.field(&name)?.at(x, y);
            let message =
                format!("layer `{name}` became {value} at column {x}, row {y}; gentler parameters may help");
            let fault =
                weald::error::NotFinite { step: None, iteration: None, layer: name, cell: [x, y], message };
            return Err(fault.into());
        }
    }
    Ok(())
}

/// Names of the layers that a step writes.
pub(crate) fn written(step: &dyn Step, landscape: &Landscape) -> Vec<String> {
    let mut names: Vec<_> = step.writes().into_iter().map(|(name, _)| name).collect();
    if step.layered() == Layered::Changes {
        names.extend(material::layer_names(&landscape.materials).map(str::to_owned));
    }
    if landscape.domain.sea_level.is_some() {
        names.extend(
            sea::LAYERS.iter().filter(|name| landscape.layer(name).is_ok()).map(|&name| name.to_owned()),
        );
    }
    names
}
