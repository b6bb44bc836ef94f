//! What a running step sees of the run: progress goes out, checkpoints go to disk.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::{Progress, Run};
use crate::engine::{SavedSimulation, Watcher};
use crate::error::Error;
use crate::recipe::checkpoint::{self, State};

/// The watcher of one step.
pub(super) struct Desk<'a> {
    run: &'a Run<'a>,
    state: &'a State,
    progress: &'a dyn Progress,
    log: Mutex<Log>,
}

/// When the last checkpoint was written, and of which iteration.
struct Log {
    at: Instant,
    iteration: Option<u64>,
}

impl<'a> Desk<'a> {
    pub(super) fn new(run: &'a Run<'a>, state: &'a State, progress: &'a dyn Progress) -> Self {
        let log = Mutex::new(Log { at: Instant::now(), iteration: None });
        Self { run, state, progress, log }
    }

    /// The step's place in the recipe, counted from 1.
    pub(super) fn number(&self) -> usize {
        self.state.done + 1
    }

    /// The iteration of the last checkpoint of this step.
    pub(super) fn kept(&self) -> Option<u64> {
        self.log().iteration
    }

    /// Keeps the state from before the step, unless there is a later one.
    pub(super) fn keep_start_unless(&self, kept: bool) -> Result<(), Error> {
        if kept {
            return Ok(());
        }
        checkpoint::write(&self.run.checkpoint(), self.run.recipe.effective(), self.state, None)
    }

    /// A panic elsewhere leaves the log whole, since it is only ever replaced.
    fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watcher for Desk<'_> {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.progress.progress(done, total, cells);
    }

    fn cancelled(&self) -> bool {
        self.progress.cancelled()
    }

    fn checkpoint_due(&self) -> bool {
        self.log().at.elapsed() >= self.run.options.checkpoint_every
    }

    fn checkpoint(&self, simulation: &SavedSimulation) -> Result<(), Error> {
        let path = self.run.checkpoint();
        checkpoint::write(&path, self.run.recipe.effective(), self.state, Some(simulation))?;
        *self.log() = Log { at: Instant::now(), iteration: Some(simulation.iteration) };
        Ok(())
    }
}
