//! What the page knows of the ground: its heights, and where water runs on it, which it works out for itself where
//! the recipe did not.

use super::figures::{count, number};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::sea;
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::analyse::flow_step::FlowStep;
use weald_land::analyse::rivers::{Rivers, RiversStep};

/// Layers that the step `flow` writes.
const FLOW: [&str; 2] = ["flow_direction", "accumulation"];

/// Layers that [`Rivers::of`] needs beside them.
const RIVERS: [&str; 5] = ["river", "river_width", "river_depth", "river_level", "discharge"];
const ORDER: &str = "strahler";
const LAKE: &str = "lake";

/// The ground with the water on it.
pub(super) struct Ground {
    /// Heights, flow and rivers.
    pub(super) land: Landscape,
    /// Name of the layer of heights.
    pub(super) height: String,
    /// Heights of all land, lowest first: of cells with data that no sea covers.
    pub(super) sorted: Vec<f32>,
    /// All rivers.
    pub(super) rivers: Rivers,
    /// Whether flow and rivers are the recipe's own.
    pub(super) from_the_recipe: bool,
}

impl Ground {
    pub(super) fn of(landscape: &Landscape, height: &str) -> Result<Self, Error> {
        let mut land = Landscape::new(landscape.domain.clone());
        let field = landscape.field(height)?;
        land.insert(height, "m", field.clone());
        let own = FLOW.iter().chain(&RIVERS).chain([&ORDER]);
        let from_the_recipe = own.clone().all(|name| landscape.layer(name).is_ok());
        if from_the_recipe {
            for name in own.chain([&LAKE]) {
                if let Ok(layer) = landscape.layer(name) {
                    land.insert(name, &layer.unit, layer.field.clone());
                }
            }
        } else {
            let of = LayerName::of(height);
            FlowStep { of: of.clone(), ..FlowStep::default() }.run(&mut land, &Job::unwatched(0))?;
            RiversStep { of, ..RiversStep::default() }.run(&mut land, &Job::unwatched(0))?;
        }
        let rivers = Rivers::of(&land)?;
        let mut sorted = heights_of_land(&land, field);
        sorted.sort_unstable_by(f32::total_cmp);
        Ok(Self { land, height: height.to_owned(), sorted, rivers, from_the_recipe })
    }

    /// How the water was led, for captions.
    pub(super) fn source(&self) -> &'static str {
        if self.from_the_recipe {
            "Flow and rivers are those of the recipe."
        } else {
            "The recipe has no steps <code>flow</code> and <code>rivers</code>: the page led water over the ground with \
             their defaults."
        }
    }
}

/// Heights of the cells with data that no sea covers; of all with data where the sea covers all.
fn heights_of_land(land: &Landscape, height: &Field) -> Vec<f32> {
    let sea = sea::cells(land, height);
    let has_data = |cell: usize| land.domain.valid.as_ref().is_none_or(|mask| mask.is_valid_at(cell));
    let is_dry = |cell: usize| sea.as_ref().is_none_or(|sea| !sea[cell]);
    let those = |wanted: &dyn Fn(usize) -> bool| -> Vec<f32> {
        let cells = height.values().iter().enumerate().filter(|&(cell, _)| wanted(cell));
        cells.map(|(_, &height)| height).collect()
    };
    let heights = those(&|cell| has_data(cell) && is_dry(cell));
    if heights.is_empty() { those(&has_data) } else { heights }
}

/// The land in one line.
pub(super) fn in_words(landscape: &Landscape, height: &str) -> Result<String, Error> {
    let domain = &landscape.domain;
    let (columns, rows) = (domain.size.columns, domain.size.rows);
    let kilometres = |cells: usize| number(cells as f64 * domain.cell / 1000.0);
    let height = landscape.field(height)?;
    let (low, high) = height.range(domain.valid.as_ref()).unwrap_or((0.0, 0.0));
    let missing = domain.size.cells() - domain.valid_cells();
    let without = if missing == 0 {
        String::new()
    } else {
        format!(", {} of them without data", count(missing as u64))
    };
    let sea = domain.sea_level.map_or_else(String::new, |level| {
        let cells =
            sea::cells(landscape, height).unwrap_or_default().into_iter().filter(|is_sea| *is_sea).count();
        let share = 100.0 * cells as f64 / domain.valid_cells().max(1) as f64;
        format!("; the sea at {} m covers {} % of it", number(level), number(share))
    });
    Ok(format!(
        "{} × {} km in {columns} × {rows} cells of {} m{without}; heights from {} to {} m{sea}.",
        kilometres(columns),
        kilometres(rows),
        number(domain.cell),
        number(f64::from(low)),
        number(f64::from(high)),
    ))
}
