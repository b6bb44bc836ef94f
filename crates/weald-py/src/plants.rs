//! Plants as columns of a table.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use weald::plants::{Plant, Plants};

/// A column for each number of a plant, and the kind and least distance of all.
pub(crate) fn columns<'py>(py: Python<'py>, plants: &Plants) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    let doubles = |name: &str, value: fn(&Plant) -> f64| {
        table.set_item(name, PyArray1::from_iter(py, plants.plants.iter().map(value)))
    };
    doubles("x", |plant| plant.place[0])?;
    doubles("y", |plant| plant.place[1])?;
    doubles("z", |plant| plant.place[2])?;
    let singles = |name: &str, value: fn(&Plant) -> f32| {
        table.set_item(name, PyArray1::from_iter(py, plants.plants.iter().map(value)))
    };
    singles("up_x", |plant| plant.up[0])?;
    singles("up_y", |plant| plant.up[1])?;
    singles("up_z", |plant| plant.up[2])?;
    singles("size", |plant| plant.size)?;
    singles("turn", |plant| plant.turn)?;
    singles("phase", |plant| plant.phase)?;
    singles("suitability", |plant| plant.suitability)?;
    Ok(table)
}
