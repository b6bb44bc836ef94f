//! The `network` step: measures of the river network that a simulation formed, for the report.
//!
//! What they are says [`network`](super::network). They depend on the grid, so only landscapes of the same size
//! compare, at the end of a dry period.

use super::network::{MEASURES, NetworkInput, measure};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Network>(
    "network",
    Stage::Analyse,
    "measures the network of rivers that a simulation formed, for the report",
    "Weald, after the claims of Han 2015, doi 10.7583/JKGS.2015.15.6.171",
);

/// Rain of `fluvial` with its defaults, in metres per second.
const DEFAULT_FLOOD: f64 = 40.0 / 3.6e6;

/// Mean rain of `hydraulic` with its defaults, in cells per iteration: 0.01 in one iteration of two.
const DEFAULT_RAIN: f64 = 0.005;

parameters! {
    /// Measures of a river network, which go into report.json as `measures`. Needs the layers that `hydraulic`
    /// writes.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::{analyse::network_step::Network, erode::hydraulic::Hydraulic};
    /// let mut landscape = Landscape::new(Domain::new(Size::new(32, 32)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, y| (x + 2 * y) as f32));
    /// Hydraulic { iterations: 120, ..Hydraulic::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let measures = Network::default().run(&mut landscape, &Job::unwatched(0))?.measures;
    /// assert_eq!(measures["drains"], 1.0, "a slope without hollows drains whole");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Network {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Layer of the depth of water in metres.
        water: LayerName = LayerName::of("water");
        /// Layer of the mean flow of water to the east, in m³ per iteration.
        flux_x: LayerName = LayerName::of("flux_x");
        /// The same to the south.
        flux_y: LayerName = LayerName::of("flux_y");
        /// Layer of what the ground lost on balance, in metres.
        erosion: LayerName = LayerName::of("erosion");
        /// Layer of what the ground gained on balance, in metres.
        deposition: LayerName = LayerName::of("deposition");
        /// Mean rain per iteration over a whole cycle: `rain` of `hydraulic` times the share of the iterations with
        /// rain. Without it 0.005 × cell size, the mean of model = "han" with its defaults; give it for every other
        /// model. With fluxes in m³/s it is metres per second, 40 mm/h without it.
        rain: Option<f64> = None, range 1.0e-9..=100.0, unit "m/iteration";
    }
}

impl Step for Network {
    fn reads(&self) -> Vec<String> {
        let layers = [&self.of, &self.water, &self.flux_x, &self.flux_y, &self.erosion, &self.deposition];
        layers.map(|name| name.0.clone()).into()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        Vec::new()
    }

    fn measures(&self) -> &'static [(&'static str, &'static str)] {
        MEASURES
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let field = |name: &LayerName| landscape.field(&name.0);
        let before = before(field(&self.of)?, field(&self.erosion)?, field(&self.deposition)?);
        let fluxes = [field(&self.flux_x)?, field(&self.flux_y)?];
        let in_seconds = landscape.layer(&self.flux_x.0)?.unit == "m³/s";
        let rain = self.rain.unwrap_or(if in_seconds { DEFAULT_FLOOD } else { DEFAULT_RAIN * domain.cell });
        let measures = measure(&NetworkInput {
            ground: field(&self.of)?,
            before: Some(&before),
            depth: field(&self.water)?,
            mean_flux_x: fluxes[0],
            mean_flux_y: fluxes[1],
            mean_rain: rain * domain.cell_area(),
            cell: domain.cell,
            valid: domain.valid.as_ref(),
        });
        let measures = measures.named().into_iter().collect();
        Ok(Outcome { iterations: 1, measures, ..Outcome::default() })
    }
}

/// The ground before the water changed it.
fn before(ground: &Field, erosion: &Field, deposition: &Field) -> Field {
    let changes = erosion.values().iter().zip(deposition.values());
    let values =
        ground.values().iter().zip(changes).map(|(now, (eroded, deposited))| now + eroded - deposited);
    Field::from_values(ground.size(), values.collect())
}
