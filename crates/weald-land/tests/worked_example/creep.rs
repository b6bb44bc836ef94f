//! The `creep` step: soil creeps down every slope, the more the steeper it is (Culling 1960, doi 10.1086/626663).
//!
//! `z' = z + K Σ (z_n - z)` over the four neighbours `n`, with heights in cells; stable for `K` up to 1/4.

use std::sync::Arc;

use super::on_ground::OnGround;
use super::pipeline::{Equations, Pipeline};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::{Job, kernel, uniform};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Creep>(
    "creep",
    Stage::Erode,
    "lets soil creep down every slope",
    "Culling 1960, doi 10.1086/626663",
);

parameters! {
    /// Creep of soil down every slope.
    pub struct Creep {
        /// Share `K` of the difference in height that moves to a lower neighbour in an iteration. Unstable above 0.25.
        rate: f64 = 0.1, range 0.0..=0.25;
        /// Iterations to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// Layer with the height of the ground.
        layer: LayerName = LayerName::of("height");
    }
}

uniform! {
    /// Constants of the method: kernels find them by their names, the shader as `constants.rate`.
    struct CreepConstants {
        rate: f32,
    }
}

kernel! {
    /// Height of the ground: that of the start, and its change since then.
    pub(crate) struct Ground {
        reads { base, change }
        writes { ground }
    }
    fn cell() {
        ground = base + change;
    }
}

kernel! {
    /// What creeps to the east and to the south; nothing where no link leads to a neighbour.
    pub(crate) struct Creeping {
        reads { ground, ground_east, ground_south, link_east, link_south }
        writes { to_east, to_south }
        constants { rate: f32 }
    }
    fn cell() {
        to_east = link_east * (rate * (ground - ground_east));
        to_south = link_south * (rate * (ground - ground_south));
    }
}

kernel! {
    /// Adds what comes and takes what goes: `to_east_west` is what the western neighbour gives to the east.
    pub(crate) struct Balance {
        reads { change, to_east, to_east_west, to_south, to_south_north }
        writes { changed }
    }
    fn cell() {
        changed = change + ((to_east_west - to_east) + (to_south_north - to_south));
    }
}

/// The kernels in their order, and their twin.
pub(super) fn equations(rate: f32) -> Arc<Pipeline> {
    let mut equations = Equations::new(&["base"], &[("change", "changed")], &CreepConstants { rate });
    equations.kernel::<Ground>().kernel::<Creeping>().kernel::<Balance>();
    equations.pass("creep", include_str!("creep.wgsl"));
    equations.finish()
}

impl Step for Creep {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.layer.0.clone(), "m")]
    }

    fn watched(&self) -> u64 {
        u64::from(self.iterations)
    }

    fn runs_over_ranks(&self) -> bool {
        true
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let alone = OnGround { name: "creep", layer: &self.layer.0, iterations: self.iterations };
        alone.run(&equations(self.rate as f32), landscape, job)
    }
}

/// The step in every variant that has code of its own.
pub(super) fn variants() -> Vec<Box<dyn Step>> {
    vec![Box::new(Creep { iterations: 21, ..Creep::default() })]
}
