//! Errors of the library as exceptions of Python, with their fields.

use std::fmt::Display;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use weald::error::{DeviceError, DeviceErrorKind, Diagnostic, Error, Limit, NotFinite, RecipeError};

/// The module that declares the exceptions.
const MODULE: &str = "weald._errors";

/// The exception of an error; one class for each who must act.
pub(crate) fn exception(py: Python<'_>, error: Error) -> PyErr {
    made(py, error).unwrap_or_else(|fault| fault)
}

/// A fault of how a function was called.
pub(crate) fn usage(py: Python<'_>, message: impl Display) -> PyErr {
    raise(py, "UsageError", &message.to_string(), PyDict::new(py)).unwrap_or_else(|fault| fault)
}

/// An exception of that class.
pub(crate) fn raise(
    py: Python<'_>,
    class: &str,
    message: &str,
    fields: Bound<'_, PyDict>,
) -> PyResult<PyErr> {
    let class = py.import(MODULE)?.getattr(class)?;
    Ok(PyErr::from_value(class.call((message,), Some(&fields))?))
}

fn made(py: Python<'_>, error: Error) -> PyResult<PyErr> {
    let fields = PyDict::new(py);
    let message = error.to_string();
    match error {
        Error::Recipe(error) => of_recipe(py, error, fields),
        Error::Input { path, what } => {
            fields.set_item("path", path)?;
            fields.set_item("what", what)?;
            raise(py, "InputError", &message, fields)
        }
        Error::Limit(limit) => {
            limit_fields(&limit, &fields)?;
            raise(py, "LimitError", &message, fields)
        }
        Error::NotFinite(NotFinite { step, iteration, layer, cell, .. }) => {
            fields.set_item("step", step)?;
            fields.set_item("iteration", iteration)?;
            fields.set_item("layer", layer)?;
            fields.set_item("cell", (cell[0], cell[1]))?;
            raise(py, "NotFiniteError", &message, fields)
        }
        Error::Device(DeviceError { kind, .. }) => {
            fields.set_item("kind", kind_of(&kind))?;
            raise(py, "DeviceError", &message, fields)
        }
        Error::Interrupted(_) => raise(py, "Cancelled", &message, fields),
        _ => raise(py, "RunError", &message, fields),
    }
}

fn of_recipe(py: Python<'_>, error: RecipeError, fields: Bound<'_, PyDict>) -> PyResult<PyErr> {
    let RecipeError { file, diagnostics } = error;
    let line = |line: usize| (line != 0 && line != Diagnostic::NO_LINE).then_some(line);
    let shown = |fault: &Diagnostic| match line(fault.line) {
        Some(line) => format!("{file}:{line}: {}", fault.message),
        None => format!("{file}: {}", fault.message),
    };
    let message = diagnostics.iter().map(shown).collect::<Vec<_>>().join("\n");
    let faults: Vec<_> = diagnostics.into_iter().map(|fault| (line(fault.line), fault.message)).collect();
    fields.set_item("file", file)?;
    fields.set_item("faults", faults)?;
    raise(py, "RecipeError", &message, fields)
}

fn limit_fields(limit: &Limit, fields: &Bound<'_, PyDict>) -> PyResult<()> {
    fields.set_item("what", format!("{:?}", limit.what))?;
    fields.set_item("asked", limit.asked)?;
    fields.set_item("allowed", (*limit.allowed.start(), *limit.allowed.end()))?;
    fields.set_item("subject", &limit.subject)?;
    fields.set_item("remedy", &limit.remedy)
}

fn kind_of(kind: &DeviceErrorKind) -> &'static str {
    match kind {
        DeviceErrorKind::NoAdapter { .. } => "no adapter",
        DeviceErrorKind::NotOpened => "not opened",
        DeviceErrorKind::OutOfMemory { .. } => "out of memory",
        DeviceErrorKind::OverLimit { .. } => "over limit",
        DeviceErrorKind::Lost { .. } => "lost",
        DeviceErrorKind::Unresponsive => "unresponsive",
        DeviceErrorKind::Unsupported { .. } => "unsupported",
        DeviceErrorKind::Misused => "misused",
        _ => "failed",
    }
}
