//! A raster from arrays that follow CF.
//!
//! Of several variables the one that holds heights is read, by its name or its `standard_name`; else there must
//! be one alone. Dimensions before the last two must be of length 1. `_FillValue`, `missing_value` and NaN are
//! no-data; `scale_factor` and `add_offset` are applied. `valid_range` is not looked at, as xarray does not.

use super::super::{Fault, Limits, Provenance, Raster};
use super::attribute::Attributes;
use super::names::{means_height, of_layer};
use super::place::Place;
use super::source::{Described, Source};
use weald_core::grid::Size;

/// Reads the layer of a file.
///
/// # Errors
/// [`Fault`] for a file without such a layer, of which one cannot be told, or that is over the limits.
pub fn read(source: &dyn Source, limits: Limits) -> Result<Raster, Fault> {
    let layer = choose(source.variables())?;
    let size = size(layer, limits)?;
    let place = Place::of(source, layer, size)?;
    let packing = Packing::of(layer);
    let (mut values, mut valid) = (vec![0.0; size.cells()], vec![true; size.cells()]);
    source.each(layer, &mut |index, number| {
        let (x, y) = (index % size.columns, index / size.columns);
        let cell = size.index(x, if place.is_south_up { size.rows - 1 - y } else { y });
        match packing.value(number) {
            Some(value) => values[cell] = value,
            None => valid[cell] = false,
        }
    })?;
    let mut raster = Raster::from_file(size, values, valid, layer.stored)?;
    raster.notes.extend(place.notes);
    let text_of = |key: &str| {
        let text = layer.attributes.text(key).or_else(|| source.attributes().text(key));
        text.map(str::to_owned)
    };
    let provenance = Provenance::from_items(text_of);
    Ok(Raster { cell: place.cell, georeference: place.georeference, provenance, ..raster })
}

fn size(layer: &Described, limits: Limits) -> Result<Size, Fault> {
    let [leading @ .., rows, columns] = layer.shape.as_slice() else {
        return Err(Fault::damaged(format!("`{}` has no rows and columns", layer.name)));
    };
    if let Some(axis) = leading.iter().position(|length| *length != 1) {
        let dimension = &layer.dimensions[axis];
        return Err(Fault::damaged(format!(
            "`{}` has {} grids along `{dimension}`; choose one, with xarray: ds.isel({dimension}=0)",
            layer.name, leading[axis]
        )));
    }
    limits.size(*columns, *rows)
}

/// The variable that holds the layer.
fn choose(variables: &[Described]) -> Result<&Described, Fault> {
    let beside: Vec<&str> = variables.iter().flat_map(|variable| companions(&variable.attributes)).collect();
    let is_layer = |variable: &&Described| {
        variable.is_number && variable.shape.len() >= 2 && !beside.contains(&variable.name.as_str())
    };
    let layers: Vec<&Described> = variables.iter().filter(is_layer).collect();
    let height = of_layer("height").and_then(|known| known.standard);
    let by_name = layers.iter().find(|layer| means_height(&layer.name));
    let by_standard = || layers.iter().find(|layer| layer.attributes.text("standard_name") == height);
    if let Some(layer) = by_name.or_else(by_standard) {
        return Ok(layer);
    }
    match layers.as_slice() {
        [layer] => Ok(layer),
        [] => Err(Fault::damaged("no variable has rows and columns of numbers")),
        [first, ..] => {
            let names: Vec<_> = layers.iter().map(|layer| layer.name.as_str()).collect();
            Err(Fault::damaged(format!(
                "none of the variables {} is called `height`; keep the one to be read, with xarray: \
                 ds[['{}']], or rename it",
                names.join(", "),
                first.name
            )))
        }
    }
}

/// Names of variables that only tell where the cells of others lie.
fn companions(attributes: &Attributes) -> impl Iterator<Item = &str> {
    let texts = ["coordinates", "bounds", "grid_mapping"].into_iter().filter_map(|key| attributes.text(key));
    texts.flat_map(str::split_whitespace)
}

/// How numbers of a file become values.
struct Packing {
    fills: Vec<f64>,
    is_single: bool,
    scale: f64,
    offset: f64,
}

impl Packing {
    fn of(layer: &Described) -> Self {
        let numbers = |name: &str| layer.attributes.numbers(name).unwrap_or_default();
        let number = |name: &str, usual: f64| layer.attributes.number(name).unwrap_or(usual);
        let default = layer.default_fill.filter(|_| layer.attributes.get("_FillValue").is_none());
        let fills = [numbers("_FillValue"), numbers("missing_value"), default.into_iter().collect()].concat();
        let (scale, offset) = (number("scale_factor", 1.0), number("add_offset", 0.0));
        Self { fills, is_single: layer.stored == "float32", scale, offset }
    }

    /// The value; `None` without data.
    fn value(&self, number: f64) -> Option<f32> {
        let is_fill = |fill: &f64| *fill == number || self.is_single && *fill as f32 == number as f32;
        if number.is_nan() || self.fills.iter().any(is_fill) {
            return None;
        }
        Some(if (self.scale, self.offset) == (1.0, 0.0) { number } else { number * self.scale + self.offset }
            as f32)
    }
}
