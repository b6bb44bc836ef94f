//! Steps of a recipe one after the other, for whoever does not write files.

use std::sync::Arc;

use web_time::Instant;

use super::cache::{Cache, KeptSteps};
use super::plan::{Planned, Recipe};
use super::run::finished::step_report;
use super::run::{Progress, inputs};
use crate::written;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::step::Outcome;
use weald_engine::{Engine, Job, Watcher};

/// The landscape before the first step, once all that can be told before it is right.
pub(super) fn start(recipe: &Recipe, progress: &dyn Progress) -> Result<Landscape, Error> {
    let (landscape, notes) = inputs::start(recipe, None)?;
    for note in &notes {
        progress.note(note);
    }
    Ok(landscape)
}

impl Recipe {
    /// The landscape after the first so many steps, of which those are taken from `cache` that it has.
    ///
    /// # Errors
    /// Those of the steps, and [`Error::Interrupted`] where `progress` says so.
    pub fn landscape_after(
        &self,
        steps: usize,
        engine: &Engine,
        cache: Option<&Arc<Cache>>,
        progress: &dyn Progress,
    ) -> Result<Landscape, Error> {
        let mut landscape = start(self, progress)?;
        let mut kept = cache.map(|cache| KeptSteps::new(cache, self, (&landscape, engine))).transpose()?;
        for (number, planned) in self.steps.iter().take(steps).enumerate() {
            if progress.cancelled() {
                return Err(Error::Interrupted("stopped between two steps".to_owned()));
            }
            progress.step(number + 1, self.steps.len(), planned.entry.name);
            step((self, planned), &mut landscape, (engine, kept.as_mut()), progress)?;
        }
        self.on_own_grid(steps, landscape)
    }
}

/// Runs a step of a recipe, or takes its result from an earlier run.
pub(super) fn step(
    of: (&Recipe, &Planned),
    landscape: &mut Landscape,
    (engine, kept): (&Engine, Option<&mut KeptSteps>),
    progress: &dyn Progress,
) -> Result<(), Error> {
    let Some(kept) = kept else { return run_step(of, landscape, engine, progress).map(drop) };
    if kept.fetch(of, landscape).is_some() {
        return Ok(());
    }
    let (before, started) = (landscape.clone(), Instant::now());
    let outcome = run_step(of, landscape, engine, progress)?;
    let report =
        step_report(of.1, landscape.domain.size.cells(), outcome, started.elapsed().as_secs_f64(), None);
    kept.keep(of, (&before, landscape), &report, &|note| progress.note(note));
    Ok(())
}

/// Runs a step of a recipe.
fn run_step(
    (recipe, planned): (&Recipe, &Planned),
    landscape: &mut Landscape,
    engine: &Engine,
    progress: &dyn Progress,
) -> Result<Outcome, Error> {
    let (seed, watcher) = (planned.seed(recipe.seed), Told(progress));
    let job = Job { seed, engine: engine.clone(), watcher: &watcher, resume: None };
    let outcome = planned.step.run(landscape, &job)?;
    written::finish(planned.step.as_ref(), landscape)?;
    for note in &outcome.notes {
        progress.note(note);
    }
    Ok(outcome)
}

/// Tells how far a simulation is, and stops it where the user wants it.
struct Told<'a>(&'a dyn Progress);

impl Watcher for Told<'_> {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.0.progress(done, total, cells);
    }

    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
