//! Values of Python as those of a recipe: keyword arguments become the keys of a table.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyString, PyTuple};
use weald::recipe::source::{Node, Table, Value};

/// A table of keyword arguments, without those that are `None`.
pub(crate) fn table(keys: &Bound<'_, PyDict>) -> PyResult<Table> {
    let mut table = Table::default();
    for (key, value) in keys {
        let key: String = key.extract()?;
        if !value.is_none() {
            let value = value_of(&value).map_err(|error| named(&key, &error, value.py()))?;
            table.entries.push((key, Node { line: 0, value }));
        }
    }
    Ok(table)
}

fn named(key: &str, error: &PyErr, py: Python<'_>) -> PyErr {
    PyTypeError::new_err(format!("`{key}` {}", error.value(py)))
}

fn value_of(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Value::Flag(flag.is_true()));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::Text(text.to_string()));
    }
    if let Ok(keys) = value.cast::<PyDict>() {
        return table(keys).map(Value::Table);
    }
    if value.cast::<PyList>().is_ok() || value.cast::<PyTuple>().is_ok() {
        let nodes = value.try_iter()?.map(|item| Ok(Node { line: 0, value: value_of(&item?)? }));
        return nodes.collect::<PyResult<_>>().map(Value::List);
    }
    if value.hasattr("tolist")? {
        return value_of(&value.call_method0("tolist")?); // arrays and scalars of NumPy
    }
    if value.hasattr("__fspath__")? {
        return Ok(Value::Text(value.call_method0("__fspath__")?.extract()?));
    }
    if let Ok(number) = value.extract::<i64>() {
        return Ok(Value::Integer(number));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Value::Number(number));
    }
    let kind = value.get_type().name()?;
    Err(PyTypeError::new_err(format!("is a {kind}, but must be a number, a flag, a word or a list")))
}
