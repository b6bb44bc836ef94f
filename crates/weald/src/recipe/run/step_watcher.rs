//! What a running step sees of the run: progress goes out, checkpoints go to disk.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use web_time::Instant;

use super::film::TimeLapses;
use super::options::{Progress, Run};
use crate::recipe::checkpoint::{self, State};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::sea;
use weald_engine::{SavedSimulation, Watcher};

/// Says when the next checkpoint is due. It runs on from step to step: a recipe of many short steps is a long
/// run too.
pub(super) struct CheckpointTimer {
    every: Duration,
    last: Mutex<Instant>,
}

impl CheckpointTimer {
    pub(super) fn start(every: Duration) -> Self {
        Self { every, last: Mutex::new(Instant::now()) }
    }

    pub(super) fn is_due(&self) -> bool {
        locked(&self.last).elapsed() >= self.every
    }

    /// A checkpoint was written.
    pub(super) fn restart(&self) {
        *locked(&self.last) = Instant::now();
    }
}

/// The watcher of one step.
pub(super) struct StepWatcher<'a> {
    run: &'a Run<'a>,
    state: &'a State,
    progress: &'a dyn Progress,
    clock: &'a CheckpointTimer,
    /// The iteration of the last checkpoint.
    kept: Mutex<Option<u64>>,
    lapses: TimeLapses<'a>,
}

impl<'a> StepWatcher<'a> {
    pub(super) fn new(
        run: &'a Run<'a>,
        state: &'a State,
        progress: &'a dyn Progress,
        clock: &'a CheckpointTimer,
    ) -> Self {
        let lapses = TimeLapses::during(run.recipe, state.done, &run.options);
        Self { run, state, progress, clock, kept: Mutex::new(None), lapses }
    }

    /// The step's place in the recipe, counted from 1.
    pub(super) fn number(&self) -> usize {
        self.state.done + 1
    }

    /// The iteration of the last checkpoint of this step.
    pub(super) fn kept(&self) -> Option<u64> {
        *locked(&self.kept)
    }

    /// Keeps the state from before the step, unless there is a later one.
    pub(super) fn keep_start_unless(&self, kept: bool) -> Result<(), Error> {
        if kept {
            return Ok(());
        }
        checkpoint::write(&self.run.checkpoint(), self.run.recipe.effective(), self.state, None)
    }
}

/// Tells that a checkpoint could not be written, with which a run goes on: the checkpoint before it is still there. Where
/// the user wants the run to end it is an error, for it would be lost. Gives whether it was written.
pub(super) fn note_failure(written: Result<(), Error>, progress: &dyn Progress) -> Result<bool, Error> {
    match written {
        Err(Error::Run(what)) if !progress.cancelled() => {
            progress.note(&format!("no checkpoint: {what}; the run goes on"));
            Ok(false)
        }
        other => other.map(|()| true),
    }
}

/// A panic elsewhere leaves what is locked here whole, since it is only ever replaced.
pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Watcher for StepWatcher<'_> {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.progress.progress(done, total, cells);
    }

    fn cancelled(&self) -> bool {
        self.progress.cancelled()
    }

    fn checkpoint_due(&self) -> bool {
        self.clock.is_due()
    }

    fn next_look(&self, done: u64) -> Option<u64> {
        self.lapses.next(done)
    }

    fn look(&self, done: u64, landscape: &Landscape) -> Result<(), Error> {
        let mut seen = landscape.clone();
        sea::stand(&mut seen)?;
        self.lapses.draw(done, &seen)
    }

    fn checkpoint(&self, simulation: &SavedSimulation) -> Result<(), Error> {
        let path = self.run.checkpoint();
        let written = checkpoint::write(&path, self.run.recipe.effective(), self.state, Some(simulation));
        let is_kept = note_failure(written, self.progress)?;
        self.clock.restart();
        if is_kept {
            *locked(&self.kept) = Some(simulation.iteration);
        }
        Ok(())
    }
}
