//! The step `rivers`.

use rayon::prelude::*;

use super::network::Network;
use crate::analyse::CELLS_PER_TASK;
use crate::analyse::flow_step::MILLIMETRES_PER_YEAR;
use crate::flow::directions::Directions;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<RiversStep>(
    "rivers",
    Stage::Analyse,
    "finds rivers by their upslope area, with discharge, width, depth and order",
    "Leopold and Maddock 1953; Moody and Troutman 2002; Strahler 1957",
);

/// Without `area`, a river drains at least this share of the land.
const SHARE_OF_THE_LAND: f64 = 1.0 / 500.0;

parameters! {
    /// Rivers, from layers that the step `flow` writes.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::{flow_step::FlowStep, rivers::RiversStep};
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 20)?, 10.0)); // columns, rows, metres
    /// let valley = |x, y| 5.0 * (x as f32 - 4.0).abs() - 0.1 * y as f32;
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valley));
    /// FlowStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// RiversStep { area: Some(5000.0), ..RiversStep::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let river = landscape.field("river")?;
    /// assert_eq!((river.at(4, 19), river.at(4, 0), river.at(0, 10)), (1.0, 0.0, 0.0), "on the floor below its head");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct RiversStep {
        /// Heights from which the level of the water is taken: `height`, or the layer that `flow` writes with `filled`.
        of: LayerName = LayerName::of("height");
        /// Least upslope area of a river. Without it, a five-hundredth of the land.
        area: Option<f64> = None, range 0.0..=1.0e15, unit "m²";
        /// Runoff of the land: mean annual discharge = upslope area × runoff. Water of a simulation does not enter it.
        runoff: f64 = 500.0, range 0.0..=1.0e5, unit "mm/year", without discharge;
        /// Layer of mean annual discharge in m³/s, such as `flow` writes with `weight`, which is taken instead of
        /// `runoff`.
        discharge: Option<LayerName> = None;
        /// Layer of lakes, such as `lakes` writes. Rivers end at their shores and begin at their outlets.
        lakes: Option<LayerName> = None;
        /// Width of a river of 1 m³/s, by its mean annual discharge.
        width: f64 = 7.2, range 0.0..=1.0e4, unit "m";
        /// Width grows with discharge to this power.
        width_exponent: f64 = 0.5, range 0.0..=2.0;
        /// Depth of a river of 1 m³/s, by its mean annual discharge.
        depth: f64 = 0.27, range 0.0..=1.0e4, unit "m";
        /// Depth grows with discharge to this power.
        depth_exponent: f64 = 0.4, range 0.0..=2.0;
    }
}

/// Layers that the step writes, with their units.
const LAYERS: [(&str, &str); 6] = [
    ("river", "1"),
    ("river_width", "m"),
    ("river_depth", "m"),
    ("river_level", "m"),
    ("discharge", "m³/s"),
    ("strahler", "1"),
];

impl Step for RiversStep {
    fn reads(&self) -> Vec<String> {
        let needed = [self.of.0.as_str(), "flow_direction", "accumulation"].map(str::to_owned);
        let chosen = [&self.discharge, &self.lakes].into_iter().flatten().map(|name| name.0.clone());
        needed.into_iter().chain(chosen).collect()
    }

    fn reads_where_there(&self) -> Vec<String> {
        vec!["lake".to_owned()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        LAYERS.map(|(name, unit)| (name.to_owned(), unit)).to_vec()
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        Some(match layer {
            "river" => (0.0, 1.0),
            "river_level" => (f64::NEG_INFINITY, f64::INFINITY),
            _ => (0.0, f64::INFINITY),
        })
    }

    fn bytes_per_cell(&self) -> u64 {
        36
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let directions = Directions::of(landscape.field("flow_direction")?, domain.valid.as_ref())?;
        let upslope = landscape.field("accumulation")?;
        let least = self.area.unwrap_or(SHARE_OF_THE_LAND * domain.valid_cells() as f64 * domain.cell_area());
        let network = Network::of(&directions, upslope, domain.valid.as_ref(), least);
        let discharge = self.discharges(landscape)?;
        let lakes = self.lakes.as_ref().map(|name| landscape.field(&name.0)).transpose()?;
        let is_lake = |cell: usize| lakes.is_some_and(|lakes| lakes.values()[cell] > 0.0);
        let of_river = |cell: usize| network.member[cell] && !directions.is_sea(cell) && !is_lake(cell);
        let cells = || (0..network.member.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
        let on_rivers = |value: &(dyn Fn(usize) -> f64 + Sync)| {
            let values = cells().map(|cell| if of_river(cell) { value(cell) as f32 } else { 0.0 });
            Field::from_values(domain.size, values.collect())
        };
        let power = |cell: usize, exponent| libm::pow(f64::from(discharge.values()[cell]).max(0.0), exponent);
        let levels = network.levels(&directions, landscape.field(&self.of.0)?);
        let orders = network.orders(&directions, is_lake);
        let none = !cells().any(of_river);
        let largest = upslope.values().iter().copied().fold(0.0, f32::max);
        let note = format!("there is no river: `area` is {least} m², the largest upslope area {largest} m²");
        let fields = [
            on_rivers(&|_| 1.0),
            on_rivers(&|cell| self.width * power(cell, self.width_exponent)),
            on_rivers(&|cell| self.depth * power(cell, self.depth_exponent)),
            Field::from_values(domain.size, levels),
            discharge,
            on_rivers(&|cell| f64::from(orders[cell])),
        ];
        for ((name, unit), field) in LAYERS.into_iter().zip(fields) {
            landscape.insert(name, unit, field);
        }
        let notes = none.then_some(note).into_iter().collect();
        Ok(Outcome { iterations: 1, notes, ..Outcome::default() })
    }
}

impl RiversStep {
    /// Discharge of each cell in m³/s.
    fn discharges(&self, landscape: &Landscape) -> Result<Field, Error> {
        if let Some(name) = &self.discharge {
            return Ok(landscape.field(&name.0)?.clone());
        }
        let mut discharge = landscape.field("accumulation")?.clone();
        discharge.values_mut().par_iter_mut().with_min_len(CELLS_PER_TASK).for_each(|value| {
            *value = (f64::from(*value) * self.runoff * MILLIMETRES_PER_YEAR) as f32;
        });
        Ok(discharge)
    }
}
