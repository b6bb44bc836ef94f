//! Runs a pipeline on the ground of a landscape, for steps that are one.
//!
//! Its first constant plane is `base`, the ground of the start; its first state plane is the change of the ground
//! since then, both in cells.

use std::sync::Arc;

use super::pipeline::{Pipeline, Stepped};
use super::simulation::Simulation;
use super::working::WorkingGrid;
use crate::erode::finished::Finished;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::step::Outcome;

/// What a step is called, which layer it changes and how long it runs.
pub(crate) struct OnGround<'a> {
    pub(crate) name: &'static str,
    pub(crate) layer: &'a str,
    pub(crate) iterations: u32,
}

impl OnGround<'_> {
    /// Runs the pipeline.
    pub(crate) fn run(
        &self,
        pipeline: &Arc<Pipeline>,
        landscape: &mut Landscape,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        let working = WorkingGrid::new(landscape, self.layer, false)?;
        let iterations = u64::from(self.iterations);
        let process: Stepped = Stepped::new(self.name, pipeline, (working.size, working.mask.is_some()));
        let plane_names = process.state_names();
        let seen = |finished: &Finished| {
            let mut seen = landscape.clone();
            working.store_ground(&mut seen, self.layer, finished, iterations);
            seen
        };
        let simulation =
            Simulation { seen: Some(&seen), ..Simulation::alone(&process, &plane_names, self.iterations) };
        working.show(job)?;
        let finished = simulation.run(working.state(plane_names.len(), &[]), job)?;
        Ok(working.store_ground(landscape, self.layer, &finished, iterations))
    }
}
