//! A recipe over ranks. The first runs it and has all files; the others take part in the steps that run over ranks, for
//! which they get the layers that the step reads.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::checkpoint::{pack_landscape, unpack_landscape};
use super::ground;
use super::plan::{Planned, Recipe};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::BEDROCK;
use weald_engine::ranks::Ranks;
use weald_engine::step::Layered;
use weald_engine::{Engine, Job, Unwatched};

/// What is told when a step, or the run, is over.
const OVER: Vec<u8> = Vec::new();

/// Runs a recipe on the first rank, and lets the others go when that has ended, however it did.
///
/// # Errors
/// [`Error::Run`] on another rank, which takes part in place of that.
pub(super) fn leading<T>(engine: &Engine, run: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let Engine::Ranks(ranks) = engine else { return run() };
    if !ranks.leads() {
        let rank = ranks.rank();
        return Err(Error::Run(format!("rank {rank} was to run a recipe, which the first rank does alone")));
    }
    let done = run();
    // Who cannot be reached any more waits for nothing.
    let _ = ranks.tell(OVER);
    done
}

/// Where a step runs: on the first rank alone, if it does not run over ranks.
pub(super) fn engine_of(planned: &Planned, engine: &Engine) -> Engine {
    match engine {
        Engine::Ranks(_) if !planned.step.runs_over_ranks() => Engine::Cpu,
        engine => engine.clone(),
    }
}

/// Runs a step on its engine, with the other ranks where that is ranks.
pub(super) fn with_others<T>(
    engine: &Engine,
    (index, planned): (usize, &Planned),
    landscape: &Landscape,
    run: impl FnOnce() -> Result<T, Error>,
) -> Result<T, Error> {
    let Engine::Ranks(ranks) = engine else { return run() };
    let mut message = (index as u64).to_le_bytes().to_vec();
    message.extend(pack_landscape(&read_by(planned, landscape)));
    ranks.tell(message)?;
    let done = run();
    let told = ranks.tell(OVER);
    let done = done?;
    told.map(|_| done)
}

/// The layers that a step reads, on their grid.
fn read_by(planned: &Planned, landscape: &Landscape) -> Landscape {
    let step = &planned.step;
    let mut names: BTreeSet<String> = step.reads().into_iter().chain(step.reads_where_there()).collect();
    if step.layered() != Layered::Never {
        names.extend(landscape.materials.iter().map(|material| material.name.clone()));
        names.insert(BEDROCK.to_owned());
    }
    let mut part = Landscape::new(landscape.domain.clone());
    for (name, layer) in landscape.layers().filter(|(name, _)| names.contains(*name)) {
        part.insert(name, &layer.unit, layer.field.clone());
    }
    part
}

/// Takes part in a run that the first rank leads, to its end. All ranks have the same recipe, and the files of its
/// scripts of strokes.
///
/// # Errors
/// [`Error::Run`] where another rank can no longer be reached or has another recipe; those of a step that cannot begin
/// here as it did there.
pub fn take_part(recipe: &Recipe, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    loop {
        let message = ranks.tell(Vec::new())?;
        let Some((index, landscape)) = message.split_first_chunk() else { return Ok(()) };
        let index = u64::from_le_bytes(*index) as usize;
        let planned = recipe.steps.get(index).ok_or_else(|| {
            Error::Run(format!(
                "rank {} has a recipe without step {}, another than rank 0",
                ranks.rank(),
                index + 1
            ))
        })?;
        let mut landscape = unpack_landscape(landscape)?;
        drop(message);
        landscape.materials = ground::materials(recipe);
        take_part_in(planned, recipe.seed, landscape, ranks)?;
    }
}

fn take_part_in(
    planned: &Planned,
    seed: u64,
    mut landscape: Landscape,
    ranks: &Arc<dyn Ranks>,
) -> Result<(), Error> {
    let engine = Engine::Ranks(Arc::clone(ranks));
    let job = Job { seed: planned.seed(seed), engine, watcher: &Unwatched, resume: None };
    match planned.step.run(&mut landscape, &job) {
        // The first rank has said already that the step is over.
        Err(Error::Interrupted(_)) => Ok(()),
        Ok(_) => ranks.tell(Vec::new()).map(drop),
        Err(error) => Err(error),
    }
}
