//! What a finished step must have done, and what is reported of it.

use crate::recipe::plan::Planned;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::layer_names;
use weald_engine::report::StepReport;
use weald_engine::step::{Layered, Outcome};
use weald_plants::Vegetation;

/// All layers that a step declares must be there and hold numbers, and all plants and grass must be there.
pub(super) fn check_layers(planned: &Planned, landscape: &Landscape) -> Result<(), Error> {
    let land = landscape.domain.valid.as_ref();
    let mut written: Vec<_> = planned.step.writes().into_iter().map(|(name, _)| name).collect();
    if planned.step.layered() == Layered::Changes {
        written.extend(layer_names(&landscape.materials).map(str::to_owned));
    }
    for name in written {
        let field = landscape.field(&name)?;
        if let Some((x, y)) = field.first_not_finite(land) {
            let value = field.at(x, y);
            return Err(Error::Run(format!(
                "layer `{name}` became {value} at column {x}, row {y}; gentler parameters may help"
            )));
        }
    }
    planned.step.plants().iter().try_for_each(|name| landscape.plants(name).map(drop))?;
    planned.step.meadows().iter().try_for_each(|name| landscape.meadow(name).map(drop))
}

pub(super) fn step_report(
    planned: &Planned,
    landscape: &Landscape,
    outcome: Outcome,
    seconds: f64,
    resumed_at: Option<u64>,
) -> StepReport {
    let cells = landscape.domain.size.cells();
    let here = outcome.iterations.saturating_sub(resumed_at.unwrap_or(0));
    let mut notes = outcome.notes;
    if let Some(iteration) = resumed_at {
        notes.push(format!(
            "went on from a checkpoint after {iteration} iterations; seconds count from there"
        ));
    }
    StepReport {
        step: planned.entry.name.to_owned(),
        seconds,
        cells,
        iterations: outcome.iterations,
        cell_updates_per_second: cells as f64 * here as f64 / seconds.max(1e-9),
        budget: outcome.budget.map(Into::into),
        measures: outcome.measures.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        notes,
    }
}
