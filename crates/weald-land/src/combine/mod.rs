//! Combination: a layer from layers, cell by cell or from a neighbourhood.
//!
//! No-data cells take part in nothing. A new layer has the unit of the layer it was made from.

pub mod add;
pub mod blend;
pub mod displace;
pub mod extremes;
pub mod layers;
pub mod remap;
pub mod resample;
pub mod smooth;
pub mod terrace;
pub mod top_material;

use rayon::prelude::*;

use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;

/// What [`Step::writes`](weald_engine::step::Step::writes) says where the unit is that of the layer read, which is
/// known only when the step runs.
pub const UNIT_OF_INPUT: &str = "unit of `layer`";

/// Cells a task works on; results do not depend on it.
const CELLS_PER_TASK: usize = 1 << 14;

/// The layer that is written: `into`, or else the one that was read.
fn target<'a>(into: Option<&'a LayerName>, layer: &'a LayerName) -> &'a str {
    &into.unwrap_or(layer).0
}

/// What a step that makes one layer from another declares as written.
fn written(into: Option<&LayerName>, layer: &LayerName) -> Vec<(String, &'static str)> {
    vec![(target(into, layer).to_owned(), UNIT_OF_INPUT)]
}

/// Stores a field that was made from `layer`, with its unit.
fn store(
    landscape: &mut Landscape,
    layer: &LayerName,
    into: Option<&LayerName>,
    field: Field,
) -> Result<(), Error> {
    let unit = landscape.layer(&layer.0)?.unit.clone();
    landscape.insert(target(into, layer), &unit, field);
    Ok(())
}

/// A field from one field, cell by cell.
fn map(field: &Field, value: impl Fn(f32) -> f32 + Sync) -> Field {
    let values = field.values().par_iter().with_min_len(CELLS_PER_TASK).map(|&v| value(v)).collect();
    Field::from_values(field.size(), values)
}

/// A field from two fields, cell by cell.
fn map_two(a: &Field, b: &Field, value: impl Fn(f32, f32) -> f32 + Sync) -> Field {
    let pairs = a.values().par_iter().zip(b.values()).with_min_len(CELLS_PER_TASK);
    Field::from_values(a.size(), pairs.map(|(&a, &b)| value(a, b)).collect())
}
