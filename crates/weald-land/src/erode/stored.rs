//! What a simulation leaves in its landscape.

use super::working::{RunResult, WorkingGrid};
use crate::erode::finished::Finished;
use crate::erode::state_planes as plane;
use weald_core::landscape::Landscape;
use weald_engine::WaterBudget;
use weald_engine::step::Outcome;

impl WorkingGrid {
    /// Writes the layers of a water simulation, whose planes begin with change, depth and sediment.
    pub(crate) fn store(
        &self,
        landscape: &mut Landscape,
        layer: &str,
        finished: &Finished,
        kept: RunResult,
    ) -> Outcome {
        let change = self.ground_change(finished);
        let [depth, sediment] = [plane::DEPTH, plane::SEDIMENT].map(|at| finished.state.gather(at));
        let cell = self.cell as f32;
        let budget = self.budget(&depth, &sediment, finished);
        landscape.insert(layer, "m", self.ground(&self.field(&change, |change| change)));
        self.store_stack(landscape, finished);
        let water = self.depths(&depth, landscape.domain.valid.as_ref());
        landscape.insert("water", "m", water);
        landscape.insert("sediment", "m", self.field(&sediment, |sediment| sediment * cell));
        let volume = cell * cell * cell;
        landscape.insert("flux_x", "m³/step", self.field(&finished.means[0], |flux| flux * volume));
        landscape.insert("flux_y", "m³/step", self.field(&finished.means[1], |flux| flux * volume));
        landscape.insert("erosion", "m", self.field(&change, |change| (-change).max(0.0) * cell));
        landscape.insert("deposition", "m", self.field(&change, |change| change.max(0.0) * cell));
        let mut notes = finished.notes.clone();
        if !kept.conserving {
            notes.push(format!(
                "this transport does not conserve sediment: {:.3e} m³ of solid were {}; transport = \"upwind\", or \
                 \"maccormack\" with `conserve`, conserves it",
                (budget.solid.error() * budget.solid.start).abs(),
                if budget.solid.error() > 0.0 { "lost" } else { "made" },
            ));
        }
        Outcome { iterations: kept.iterations, budget: Some(budget), notes, ..Outcome::default() }
    }

    /// Writes the ground alone.
    pub(crate) fn store_ground(
        &self,
        landscape: &mut Landscape,
        layer: &str,
        finished: &Finished,
        iterations: u64,
    ) -> Outcome {
        let change = self.ground_change(finished);
        landscape.insert(layer, "m", self.ground(&self.field(&change, |change| change)));
        self.store_stack(landscape, finished);
        let mut budget = self.budget(&[], &[], finished);
        budget.water = WaterBudget::default();
        Outcome { iterations, budget: Some(budget), notes: finished.notes.clone(), ..Outcome::default() }
    }
}
