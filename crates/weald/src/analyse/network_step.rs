//! The `network` step: measures of the river network that a simulation formed, for the report.
//!
//! What they are says [`network`](super::network). They depend on the grid, so only landscapes of the same size
//! compare, at the end of a dry period.

use std::collections::BTreeMap;

use super::network::{NetworkInput, measure};
use crate::engine::Job;
use crate::error::Error;
use crate::landscape::Landscape;
use crate::parameters;
use crate::recipe::parameter::LayerName;
use crate::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Network>(
    "network",
    Stage::Analyse,
    "measures the network of rivers that a simulation formed, for the report",
    "Weald, after the claims of Han 2015, doi 10.7583/JKGS.2015.15.6.171",
);

/// Mean rain of `hydraulic` with its defaults, in cells a step: 0.01 in one step of two.
const USUAL_RAIN: f64 = 0.005;

parameters! {
    /// Measures of a river network, which go into report.json as `measures`. Needs the layers that `hydraulic`
    /// writes.
    pub struct Network {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Layer of the depth of water in metres.
        water: LayerName = LayerName::of("water");
        /// Layer of the mean flow of water to the east, in m³ a step.
        flux_x: LayerName = LayerName::of("flux_x");
        /// The same to the south.
        flux_y: LayerName = LayerName::of("flux_y");
        /// Mean rain of a whole cycle of rain and sun: `rain` of `hydraulic` by the share of the steps in which it
        /// rains. Without it, 0.005 cells, which is that of `hydraulic` with its defaults.
        rain: Option<f64> = None, range 1.0e-9..=100.0, unit "m/step";
    }
}

impl Step for Network {
    fn reads(&self) -> Vec<String> {
        [&self.of, &self.water, &self.flux_x, &self.flux_y].map(|name| name.0.clone()).into()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        Vec::new()
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let cell = landscape.domain.cell;
        let rain = self.rain.unwrap_or(USUAL_RAIN * cell);
        let measures = measure(&NetworkInput {
            ground: landscape.field(&self.of.0)?,
            before: None,
            depth: landscape.field(&self.water.0)?,
            mean_flux_x: landscape.field(&self.flux_x.0)?,
            mean_flux_y: landscape.field(&self.flux_y.0)?,
            mean_rain: rain * landscape.domain.cell_area(),
            cell,
            land: landscape.domain.land.as_ref(),
        });
        let measures = BTreeMap::from([
            ("chan", measures.chan),
            ("reach", measures.reach),
            ("valley_largest", measures.valley_largest),
            ("drains", measures.drains),
            ("pits", measures.pits as f64),
        ]);
        Ok(Outcome { iterations: 1, measures, ..Outcome::default() })
    }
}
