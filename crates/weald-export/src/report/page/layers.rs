//! A map and the statistics of each layer.

use rayon::prelude::*;

use super::figures::{number, rough};
use super::html::{Cell, escape, figure, picture, table};
use crate::report::Page;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::{Landscape, Layer};
use weald_core::layer_words::shown_unit;
use weald_core::parameter::LayerName;
use weald_picture::{Map, Picture, Scale, encode};

/// Shares of the cells that lie below the first and above the last colour, so that single cells do not press all
/// others together.
const BEYOND: f64 = 0.005;

/// A layer whose higher values are so many times its middle one is drawn by powers of ten.
const SPREAD: f64 = 30.0;

/// Least value of a logarithmic map, as a share of the highest.
const DECADES: f64 = 1.0e-4;

/// Colours of a legend.
const STOPS: usize = 9;

pub(super) fn section(landscape: &Landscape, page: &Page) -> Result<String, Error> {
    let all: Vec<_> = landscape.layers().collect();
    let drawn = |&(name, layer): &(&str, &Layer)| {
        let values = Values::of(&layer.field, &landscape.domain)?;
        let has_map = page.maps && name != page.of.0;
        let map = has_map.then(|| map(landscape, (name, layer), &values, page.width / 3));
        Some((values.row(name, layer), map.unwrap_or_else(|| Ok(String::new()))))
    };
    let (mut rows, mut maps) = (Vec::new(), String::new());
    for (row, map) in all.par_iter().filter_map(drawn).collect::<Vec<_>>() {
        rows.push(row);
        maps.push_str(&map?);
    }
    let header = ["layer", "unit", "least", "median", "mean", "greatest"];
    let statistics = table("All layers, over the cells with data.", &header, &rows);
    let maps = if maps.is_empty() { maps } else { format!("<div class=\"maps\">\n{maps}</div>\n") };
    Ok(maps + &statistics)
}

/// What is to be known of the values of a layer.
struct Values {
    least: f64,
    greatest: f64,
    mean: f64,
    median: f64,
    /// Between these nearly all values lie.
    usual: [f64; 2],
}

impl Values {
    fn of(field: &Field, domain: &Domain) -> Option<Self> {
        let has_data = |cell: usize| domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let cells =
            field.values().iter().enumerate().filter(|&(cell, value)| has_data(cell) && value.is_finite());
        let mut sorted: Vec<f32> = cells.map(|(_, &value)| value).collect();
        sorted.sort_unstable_by(f32::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |share: f64| f64::from(sorted[(share * last as f64).round() as usize]);
        let mean = sorted.iter().map(|&value| f64::from(value)).sum::<f64>() / sorted.len() as f64;
        Some(Self {
            least: at(0.0),
            greatest: at(1.0),
            mean,
            median: at(0.5),
            usual: [at(BEYOND), at(1.0 - BEYOND)],
        })
    }

    fn row(&self, name: &str, layer: &Layer) -> Vec<Cell> {
        let numbers = [self.least, self.median, self.mean, self.greatest];
        let words = [Cell::text(name), Cell::text(unit(layer))];
        words.into_iter().chain(numbers.map(|value| Cell::number(number(value)))).collect()
    }

    fn is_a_mask(&self, layer: &Layer) -> bool {
        layer.unit == "1" && self.least >= 0.0 && self.greatest <= 1.0
    }

    fn is_logarithmic(&self, layer: &Layer) -> bool {
        let high = self.usual[1].max(self.greatest * DECADES);
        !self.is_a_mask(layer) && self.least >= 0.0 && high > SPREAD * self.median && high > 0.0
    }

    /// Values of the first and the last colour.
    fn shown(&self, layer: &Layer) -> [f64; 2] {
        if self.is_a_mask(layer) {
            [0.0, 1.0]
        } else if self.is_logarithmic(layer) {
            [self.greatest * DECADES, self.greatest]
        } else if layer.unit == "deg" {
            [self.least, self.greatest]
        } else if self.usual[0] < 0.0 && self.usual[1] > 0.0 {
            // The middle colour is that of 0.
            let most = self.usual[1].max(-self.usual[0]);
            [-most, most]
        } else if self.usual[1] > self.usual[0] {
            self.usual
        } else {
            [self.least, self.greatest]
        }
    }
}

/// The unit of a layer, where it has one.
fn unit(layer: &Layer) -> String {
    if layer.unit == "1" { "–".to_owned() } else { shown_unit(&layer.unit) }
}

fn map(
    landscape: &Landscape,
    (name, layer): (&str, &Layer),
    values: &Values,
    width: u32,
) -> Result<String, Error> {
    let [low, high] = values.shown(layer);
    let map = Map {
        of: LayerName::of(name),
        width: Some(width),
        ramp: scale(name),
        logarithmic: values.is_logarithmic(layer),
        low: Some(low),
        high: Some(high),
        // The page has a legend of its own.
        legend: false,
    };
    let unit =
        if layer.unit == "1" { String::new() } else { format!(", {}", escape(&shown_unit(&layer.unit))) };
    let caption = format!("<strong>{}</strong>{unit}\n{}", escape(name), legend(&map, values));
    Ok(figure("map", &picture(&map.render(landscape)?, &format!("Map of the layer {name}")), &caption))
}

/// A bar of the colours with the values at its ends and in its middle.
fn legend(map: &Map, values: &Values) -> String {
    let (low, high) = (map.low.unwrap_or(0.0), map.high.unwrap_or(1.0));
    let middle = if map.logarithmic { libm::sqrt(low * high) } else { 0.5 * (low + high) };
    let ramp = map.ramp.ramp();
    let colour = |stop: usize| {
        let [red, green, blue] = encode(ramp.at(stop as f32 / (STOPS - 1) as f32));
        format!("#{red:02x}{green:02x}{blue:02x}")
    };
    let colours: Vec<_> = (0..STOPS).map(colour).collect();
    // Beside 360, a thousandth is 0.
    let nothing = if map.logarithmic { 0.0 } else { 1e-3 * (high - low) };
    let shown = |value: f64| if value.abs() < nothing { rough(0.0) } else { rough(value) };
    let less = if values.least < low { "≤ " } else { "" };
    let more = if values.greatest > high { "≥ " } else { "" };
    format!(
        "<span class=\"ramp\" style=\"background:linear-gradient(to right,{})\"></span>\n\
         <span class=\"ends\"><span>{less}{}</span><span>{}</span><span>{more}{}</span></span>",
        colours.join(","),
        shown(low),
        shown(middle),
        shown(high)
    )
}

/// Colours that suit what a layer is.
fn scale(name: &str) -> Scale {
    const WATER: [&str; 9] =
        ["water", "river", "discharge", "accumulation", "moisture", "wetness", "lake", "flux", "sediment"];
    const LIGHT: [&str; 4] = ["light", "occlusion", "sky", "mask"];
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if has(&WATER) {
        Scale::Water
    } else if has(&LIGHT) {
        Scale::Grey
    } else if name.contains("erosion") {
        Scale::Ember
    } else {
        Scale::Meadow
    }
}
