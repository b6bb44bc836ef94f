//! A raster from arrays that follow CF.
//!
//! Of several variables the one that holds heights is read, by its name or its `standard_name`; else there must
//! be one alone. Dimensions before the last two must be of length 1. `_FillValue`, `missing_value`, NaN and what lies
//! beyond `valid_min`, `valid_max` or `valid_range` is no-data; `scale_factor` and `add_offset` are applied, and lengths
//! in other units become metres.

use super::super::unit::{Measure, name_of};
use super::super::{Fault, Limits, Provenance, Raster};
use super::attribute::{Attribute, Attributes, Described, Source};
use super::names::{means_height, of_layer};
use super::place::Place;
use weald_core::grid::Size;

/// Reads the layer of a file.
///
/// # Errors
/// [`Fault`] for a file without such a layer, of which one cannot be told, or that is over the limits.
pub fn read(source: &dyn Source, limits: Limits) -> Result<Raster, Fault> {
    let layer = choose(source.variables())?;
    let size = size(layer, limits)?;
    let place = Place::of(source, layer, size)?;
    let packing = Packing::of(layer, place.vertical)?;
    let (mut values, mut valid) = (vec![0.0; size.cells()], vec![true; size.cells()]);
    source.each(layer, &mut |index, number| {
        let (x, y) = (index % size.columns, index / size.columns);
        let cell = size.index(x, if place.is_south_up { size.rows - 1 - y } else { y });
        match packing.value(number) {
            Some(value) => values[cell] = value,
            None => valid[cell] = false,
        }
    })?;
    let mut raster = Raster::from_file(size, values, valid, layer.stored)?.measured(&packing.measure);
    raster.notes.extend(place.notes);
    raster.notes.extend(left_out(source.variables(), layer));
    let text_of = |key: &str| {
        let text = layer.attributes.text(key).or_else(|| source.attributes().text(key));
        text.map(str::to_owned)
    };
    let raster = raster.with_source(Provenance::from_items(text_of));
    Ok(Raster { cell: place.cell, georeference: place.georeference, ..raster })
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

/// The variables that are layers.
fn layers(variables: &[Described]) -> Vec<&Described> {
    let beside: Vec<&str> = variables.iter().flat_map(|variable| companions(&variable.attributes)).collect();
    let is_layer = |variable: &&Described| {
        variable.is_number && variable.shape.len() >= 2 && !beside.contains(&variable.name.as_str())
    };
    variables.iter().filter(is_layer).collect()
}

/// What is said of the layers that are not read.
fn left_out(variables: &[Described], read: &Described) -> Option<String> {
    let others: Vec<String> = layers(variables)
        .iter()
        .filter(|layer| layer.name != read.name)
        .map(|layer| format!("`{}`", layer.name))
        .collect();
    let are_some = !others.is_empty();
    are_some.then(|| format!("of its variables `{}` is read; left out: {}", read.name, others.join(", ")))
}

/// The variable that holds the layer.
fn choose(variables: &[Described]) -> Result<&Described, Fault> {
    let layers = layers(variables);
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
    sign: Sign,
    /// Least and greatest number that is data.
    valid: [f64; 2],
    measure: Measure,
}

impl Packing {
    /// `vertical` are the metres in the unit of the CRS's heights.
    fn of(layer: &Described, vertical: Option<f64>) -> Result<Self, Fault> {
        if layer.attributes.text("positive") == Some("down") {
            return Err(Fault::damaged(format!(
                "`{}` counts downwards (`positive` is \"down\"), so it holds depths, not heights; with xarray: \
                 ds['{0}'] = -ds['{0}'], and remove `positive`",
                layer.name
            )));
        }
        let sign = Sign::of(layer);
        let numbers = |name: &str| sign.numbers(&layer.attributes, name);
        let number = |name: &str, usual: f64| layer.attributes.number(name).unwrap_or(usual);
        let default = layer.default_fill.filter(|_| layer.attributes.get("_FillValue").is_none());
        let fills = [numbers("_FillValue"), numbers("missing_value"), default.into_iter().collect()].concat();
        let (scale, offset) = (number("scale_factor", 1.0), number("add_offset", 0.0));
        let of_crs = vertical.map(name_of);
        let unit = layer.attributes.text("units").or(of_crs.as_deref());
        let measure = Measure::new(scale, offset, unit);
        let valid = valid(layer, sign, (scale, offset));
        Ok(Self { fills, is_single: layer.stored == "float32", sign, valid, measure })
    }

    /// The value; `None` without data.
    fn value(&self, number: f64) -> Option<f32> {
        let number = self.sign.number(number);
        let is_fill = |fill: &f64| *fill == number || self.is_single && *fill as f32 == number as f32;
        let is_valid = (self.valid[0]..=self.valid[1]).contains(&number);
        (is_valid && !self.fills.iter().any(is_fill)).then(|| self.measure.value(number))
    }
}

/// Least and greatest stored number that is data.
fn valid(layer: &Described, sign: Sign, (scale, offset): (f64, f64)) -> [f64; 2] {
    let bound = |name: &'static str, position: usize| {
        let bound = *sign.numbers(&layer.attributes, name).get(position)?;
        let is_unpacked = is_unpacked(layer, name, (scale, offset));
        Some(if is_unpacked { (bound - offset) / scale } else { bound })
    };
    let low = bound("valid_min", 0).or_else(|| bound("valid_range", 0)).unwrap_or(f64::NEG_INFINITY);
    let high = bound("valid_max", 0).or_else(|| bound("valid_range", 1)).unwrap_or(f64::INFINITY);
    // A negative scale turns a range of values around.
    if low > high { [high, low] } else { [low, high] }
}

/// Whether a bound is in values and not in stored numbers: a float, where whole numbers are packed as floats (`NetCDF`
/// Users Guide, attribute conventions, `valid_range`).
fn is_unpacked(layer: &Described, name: &str, packing: (f64, f64)) -> bool {
    let is_whole = layer.stored.contains("int");
    is_whole && packing != (1.0, 0.0) && !matches!(layer.attributes.get(name), Some(Attribute::Integers(_)))
}

/// Whether whole numbers are to be read with the other sign than their type has, as `_Unsigned` says.
#[derive(Clone, Copy)]
struct Sign {
    /// Two to the power of the bits; 0 for types that this says nothing of.
    turn: f64,
    is_unsigned: bool,
}

impl Sign {
    fn of(layer: &Described) -> Self {
        let unsigned = layer.stored.starts_with("uint");
        let bits = layer.stored.trim_start_matches("uint").trim_start_matches("int").parse::<i32>();
        let turn = bits.map_or(0.0, |bits| 2.0_f64.powi(bits));
        match layer.attributes.text("_Unsigned") {
            Some("true") => Self { turn, is_unsigned: true },
            Some("false") if unsigned => Self { turn, is_unsigned: false },
            _ => Self { turn: 0.0, is_unsigned: false },
        }
    }

    /// The numbers of an attribute.
    fn numbers(self, attributes: &Attributes, name: &str) -> Vec<f64> {
        let numbers = attributes.numbers(name).unwrap_or_default();
        numbers.into_iter().map(|number| self.number(number)).collect()
    }

    fn number(self, number: f64) -> f64 {
        match self.is_unsigned {
            true if number < 0.0 => number + self.turn,
            false if self.turn > 0.0 && number >= self.turn / 2.0 => number - self.turn,
            _ => number,
        }
    }
}
