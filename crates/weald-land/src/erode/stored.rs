//! What a simulation leaves in its landscape.

use super::working::{RunResult, WorkingGrid};
use crate::erode::finished::Finished;
use crate::erode::water_planes as plane;
use weald_core::landscape::Landscape;
use weald_engine::step::Outcome;
use weald_engine::{Budget, WaterBudget};

/// Mean fluxes through the eastern and southern side of each cell, in working units.
pub(crate) struct MeanFluxes {
    pub(crate) planes: [Vec<f32>; 2],
    /// Their unit in the landscape, and the factor to it.
    pub(crate) unit: &'static str,
    pub(crate) factor: f32,
}

impl WorkingGrid {
    /// Writes the layers of a water simulation, whose planes begin with change, depth and sediment.
    pub(crate) fn store(
        &self,
        landscape: &mut Landscape,
        layer: &str,
        finished: &Finished,
        kept: RunResult,
    ) -> Outcome {
        let planes = [finished.means[0].clone(), finished.means[1].clone()];
        let cell = self.cell as f32;
        let fluxes = MeanFluxes { planes, unit: "m³/step", factor: cell * cell * cell };
        let budget = self.store_with(landscape, layer, finished, &fluxes);
        let mut notes = finished.notes.clone();
        if !kept.conserving {
            notes.push(lost_note(&budget));
        }
        Outcome { iterations: kept.iterations, budget: Some(budget), notes, ..Outcome::default() }
    }

    /// Writes the layers, with fluxes that the model has worked out.
    pub(crate) fn store_with(
        &self,
        landscape: &mut Landscape,
        layer: &str,
        finished: &Finished,
        fluxes: &MeanFluxes,
    ) -> Budget {
        let change = self.ground_change(finished);
        let [depth, sediment] = [plane::DEPTH, plane::SEDIMENT].map(|at| finished.state.gather(at));
        let cell = self.cell as f32;
        landscape.insert(layer, "m", self.ground(&self.field(&change, |change| change)));
        self.store_stack(landscape, finished);
        let water = self.depths(&depth, landscape.domain.valid.as_ref());
        landscape.insert("water", "m", water);
        landscape.insert("sediment", "m", self.field(&sediment, |sediment| sediment * cell));
        let MeanFluxes { planes: [x, y], unit, factor } = fluxes;
        landscape.insert("flux_x", unit, self.field(x, |flux| flux * factor));
        landscape.insert("flux_y", unit, self.field(y, |flux| flux * factor));
        landscape.insert("erosion", "m", self.field(&change, |change| (-change).max(0.0) * cell));
        landscape.insert("deposition", "m", self.field(&change, |change| change.max(0.0) * cell));
        self.budget(&depth, &sediment, finished)
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

/// Tells what a transport lost that does not conserve sediment.
pub(crate) fn lost_note(budget: &Budget) -> String {
    format!(
        "this transport does not conserve sediment: {:.3e} m³ of solid were {}; transport = \"upwind\", or \
         \"maccormack\" with `conserve`, conserves it",
        budget.solid.lost().abs(),
        if budget.solid.lost() > 0.0 { "lost" } else { "made" },
    )
}
