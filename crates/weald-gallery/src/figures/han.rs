//! What the figures of Han 2015 share: runs on fractal ground, and their measures.

use rayon::prelude::*;
use weald::recipe::run_steps;

use super::ground::{SEED, start_terrain};
use super::{GalleryJob, texts};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_land::analyse::network::{NetworkInput, NetworkMeasures, measure};

/// Rain a step while it rains, in cells: the default of the method, stated here because the measures divide by
/// the mean rain.
pub(super) const RAIN: f64 = 0.01;

/// Steps of rain, and of evaporation after it.
pub(super) const PERIOD: u32 = 60;

/// Thermal weathering in every step, as the source has it, with the tangent of the angle of repose.
pub(super) fn weathered(talus: f64) -> String {
    format!("thermal = {{ scheme = \"isotropic\", talus = {talus:?}, strength = 0.05 }}")
}

/// A run to make.
#[derive(Clone, Debug)]
pub(super) struct Run {
    /// Name in tables and captions.
    pub(super) name: String,
    /// Keys beside the defaults of the method.
    pub(super) keys: String,
    /// Seed of the ground.
    pub(super) seed: u64,
    /// Cells a side.
    pub(super) side: usize,
    /// Steps, whole cycles of rain and sun: it ends with a dry period.
    pub(super) iterations: u32,
}

impl Run {
    /// On 256² cells for 3600 steps.
    pub(super) fn new(job: GalleryJob, name: &str, keys: &str) -> Self {
        let (side, iterations) = job.choose((256, 3600), (32, 120));
        Self { name: name.to_owned(), keys: keys.to_owned(), seed: SEED, side, iterations }
    }

    /// The same for each of several seeds.
    pub(super) fn for_seeds(&self, seeds: &[u64]) -> Vec<Self> {
        seeds.iter().map(|&seed| Self { seed, ..self.clone() }).collect()
    }

    fn make(&self) -> Result<FinishedRun, Error> {
        let mut landscape = start_terrain(self.side, self.seed)?;
        let before = landscape.field("height")?.clone();
        let keys = format!(
            "model = \"han\"\niterations = {}\nrain = {RAIN:?}\nrain_period = {PERIOD}\ndry_period = \
             {PERIOD}\n{}",
            self.iterations, self.keys
        );
        run_steps(&mut landscape, 0, &[("hydraulic", &keys)])?;
        let measures = network(&landscape, &before)?;
        Ok(FinishedRun { run: self.clone(), before, landscape, measures })
    }
}

/// A run with its result.
#[derive(Clone, Debug)]
pub(super) struct FinishedRun {
    pub(super) run: Run,
    /// The ground before.
    pub(super) before: Field,
    pub(super) landscape: Landscape,
    pub(super) measures: NetworkMeasures,
}

impl FinishedRun {
    /// The ground after.
    pub(super) fn ground(&self) -> &Field {
        self.landscape.field("height").expect("a run leaves ground")
    }

    /// Whether rivers have connected: twice the channels of `water` that does not erode, a valley longer than
    /// 0.15 of the side, and three tenths of the land drained.
    pub(super) fn is_network(&self, water: &Self) -> bool {
        let NetworkMeasures { chan, reach, drains, .. } = self.measures;
        chan >= 2.0 * water.measures.chan && reach > 0.15 && drains >= 0.3
    }
}

/// What [`FinishedRun::is_network`] asks for, in words.
pub(super) const RULE: &str = "a network has twice the `chan` of water that does not erode, `reach` above \
                               0.15 and `drains` of 0.3 or more";

/// Makes all runs, at the same time as far as there are cores.
pub(super) fn run_all(runs: &[Run]) -> Result<Vec<FinishedRun>, Error> {
    runs.par_iter().map(Run::make).collect()
}

fn network(landscape: &Landscape, before: &Field) -> Result<NetworkMeasures, Error> {
    Ok(measure(&NetworkInput {
        ground: landscape.field("height")?,
        before: Some(before),
        depth: landscape.field("water")?,
        mean_flux_x: landscape.field("flux_x")?,
        mean_flux_y: landscape.field("flux_y")?,
        mean_rain: RAIN / 2.0,
        cell: landscape.domain.cell,
        valid: None,
    }))
}

/// Headings above [`row`].
pub(super) fn header() -> Vec<String> {
    texts(["run", "chan", "reach", "drains", "pits"])
}

/// What they mean.
pub(super) const MEANING: &str = "`chan`: share of cells that carry the runoff of 100 cells or more. \
                                  `reach`: length of the longest connected valley over the side. `drains`: \
                                  share of the land from which water reaches a lake or the border without \
                                  crossing a pit deeper than half a cell. `pits`: cells without a lower \
                                  neighbour.";

/// Name and network measures of a run.
pub(super) fn row(ran: &FinishedRun) -> Vec<String> {
    let NetworkMeasures { chan, reach, drains, pits, .. } = ran.measures;
    vec![ran.run.name.clone(), share(chan), format!("{reach:.2}"), format!("{drains:.2}"), pits.to_string()]
}

/// A share in four digits, or as a power of ten where those would be zeros.
pub(super) fn share(share: f64) -> String {
    if share > 0.0 && share < 5e-4 { format!("{share:.0e}") } else { format!("{share:.4}") }
}

/// `name value, name value, …`.
pub(super) fn list(names: impl IntoIterator<Item = impl AsRef<str>>, values: &[String]) -> String {
    let pairs = names.into_iter().zip(values).map(|(name, value)| format!("{} {value}", name.as_ref()));
    pairs.collect::<Vec<_>>().join(", ")
}

/// A run that left this ground in the measures of which nothing flows, for tests.
#[cfg(test)]
pub(super) fn finished(ground: Field) -> FinishedRun {
    let mut landscape = Landscape::new(weald_core::domain::Domain::new(ground.size(), 1.0));
    landscape.insert("height", "m", ground.clone());
    let run =
        Run { name: String::new(), keys: String::new(), seed: 0, side: ground.size().columns, iterations: 1 };
    let measures = NetworkMeasures {
        chan: 0.0,
        river_width: None,
        reach: 0.0,
        valley_largest: 0.0,
        drains: 0.0,
        pits: 0,
        heads: 0,
        strahler: 0,
        theta: None,
        hack: None,
        flux_gini: 0.0,
        valleys: None,
        carve: None,
    };
    FinishedRun { run, before: ground, landscape, measures }
}
