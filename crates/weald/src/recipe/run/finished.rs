//! What is reported of a finished step.

use crate::recipe::memory;
use crate::recipe::plan::Planned;
use weald_engine::report::StepReport;
use weald_engine::step::Outcome;

pub(in crate::recipe) fn step_report(
    planned: &Planned,
    cells: usize,
    outcome: Outcome,
    seconds: f64,
    resumed_at: Option<u64>,
) -> StepReport {
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
        peak_memory: memory::taken(),
        cached: false,
        cells,
        iterations: outcome.iterations,
        cell_updates_per_second: cells as f64 * here as f64 / seconds.max(1e-9),
        budget: outcome.budget.map(Into::into),
        measures: outcome.measures.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        notes,
    }
}
