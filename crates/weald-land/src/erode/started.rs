//! A simulation of a step before its first iteration: what it begins with, and what it leaves.

use std::ops::Range;
use std::sync::Arc;

use super::edits::Place;
use super::finished::Finished;
use super::over_ranks::Beginning;
use super::scripted::{Edits, Numbers, Remake};
use super::simulation::{Record, Simulation};
use super::working::WorkingGrid;
use crate::edit::Script;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::machine::Means;
use weald_engine::stencil::chain::Process;
use weald_engine::stencil::rows::Rows;
use weald_engine::step::Outcome;

/// Writes what a simulation of so many iterations leaves.
pub(crate) type Store = Arc<dyn Fn(&mut Landscape, &Finished, u64) -> Result<Outcome, Error> + Send + Sync>;

/// Makes the state before the first step, of which ranks that another one leads have no need.
pub(crate) type Start = Box<dyn FnOnce() -> Rows + Send>;

/// What a simulation begins with.
pub(crate) struct StartedSimulation<P: Process> {
    pub(crate) numbers: Numbers<P>,
    /// Reads the keys anew after some were set.
    pub(crate) remake: Remake<P>,
    pub(crate) plane_names: Vec<String>,
    /// Parts of each mean that is kept.
    pub(crate) means: Means<'static>,
    pub(crate) start: Start,
    /// Where strokes fall, where they can.
    pub(crate) place: Option<Arc<Place>>,
    /// Where the ground lies, for those who look on.
    pub(crate) working: Option<Arc<WorkingGrid>>,
    pub(crate) store: Store,
}

/// How long a simulation runs, and what happens to it.
pub(crate) struct Course {
    pub(crate) iterations: u64,
    /// Iterations over which means are taken.
    pub(crate) record: Range<u64>,
    pub(crate) script: Option<Script>,
    /// Whether its states can be looked at.
    pub(crate) seen: bool,
}

impl Course {
    /// So many iterations without means.
    pub(crate) fn of(iterations: u32, script: Option<Script>) -> Self {
        let iterations = u64::from(iterations);
        Self { iterations, record: iterations..iterations, script, seen: true }
    }
}

/// What a process answers that follows no script.
pub(crate) fn unscripted<P: Process>() -> Remake<P> {
    Arc::new(|_| Err(Error::Run("this simulation was not begun to be changed".to_owned())))
}

impl<P: Process> StartedSimulation<P> {
    /// Runs it to its end. Over ranks the landscape of the first alone changes.
    pub(crate) fn run(
        self,
        course: Course,
        landscape: &mut Landscape,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        let Self { numbers, remake, plane_names, means, start, place, working, store } = self;
        let Course { iterations, record, script, seen: is_seen } = course;
        let edits = script.map(|script| Edits { script, place, remake });
        let seen = |finished: &Finished| {
            let mut seen = landscape.clone();
            store(&mut seen, finished, iterations)?;
            Ok(seen)
        };
        if let Some(working) = &working {
            working.show(&job.engine)?;
        }
        let simulation = Simulation {
            numbers: &numbers,
            plane_names: &plane_names,
            iterations,
            record: Some(Record { steps: record, means }),
            edits: edits.as_ref(),
            seen: is_seen.then_some(&seen),
        };
        match simulation.run(Beginning::of(&job.engine, || Ok(start()))?, job)? {
            Some(finished) => store(landscape, &finished, iterations),
            None => Ok(Outcome::default()),
        }
    }
}
