//! What a running step knows of the world: seed, engine, progress, interruption, checkpoints.

use crate::engine::Engine;
use crate::stored::StoredLandscape;
use crate::stored_state::StoredState;
use weald_core::error::Error;
use weald_core::landscape::Landscape;

/// What a step is given beside the landscape.
pub struct Job<'a> {
    /// Seed of this step.
    pub seed: u64,
    /// Where simulations run.
    pub engine: Engine,
    /// Receives progress, keeps checkpoints, says when to stop.
    pub watcher: &'a dyn Watcher,
    /// State to go on from, where this step was interrupted before; of one on a stored landscape that [has
    /// it](StoredLandscape::resumed).
    pub resume: Option<SavedSimulation>,
}

impl std::fmt::Debug for Job<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("Job")
            .field("seed", &self.seed)
            .field("engine", &self.engine)
            .finish_non_exhaustive()
    }
}

/// The outside world of a run. Every method has a default that does nothing.
pub trait Watcher: Sync {
    /// A simulation has done `done` of `total` iterations over `cells` cells each.
    fn progress(&self, done: u64, total: u64, cells: usize) {
        let _ = (done, total, cells);
    }

    /// Whether the user wants the run to end.
    fn cancelled(&self) -> bool {
        false
    }

    /// Whether the time has come for a checkpoint.
    fn checkpoint_due(&self) -> bool {
        false
    }

    /// The first number of steps, from `done` on, after which it wants to see the landscape.
    fn next_look(&self, done: u64) -> Option<u64> {
        let _ = done;
        None
    }

    /// Sees the landscape of the running simulation after `done` steps.
    ///
    /// # Errors
    /// [`Error::Run`] where what is made of it cannot be written.
    fn look(&self, done: u64, landscape: &Landscape) -> Result<(), Error> {
        let _ = (done, landscape);
        Ok(())
    }

    /// Keeps the state of the running simulation.
    ///
    /// # Errors
    /// [`Error::Run`] where the state cannot be written.
    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        let _ = state;
        Ok(())
    }

    /// Keeps the state of a running simulation on a stored landscape, with what that holds beside it. All ranks call it
    /// together.
    ///
    /// # Errors
    /// As [`Watcher::checkpoint`], on all ranks.
    fn keep(&self, landscape: &StoredLandscape<'_>, state: &StoredState<'_>) -> Result<(), Error> {
        let _ = (landscape, state);
        Ok(())
    }
}

/// A watcher that does nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watcher for Unwatched {}

impl Job<'static> {
    /// A job on the CPU that nobody watches.
    pub fn unwatched(seed: u64) -> Self {
        Self { seed, engine: Engine::Cpu, watcher: &Unwatched, resume: None }
    }
}

/// The whole state of a simulation between two of its steps.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct SavedSimulation {
    /// Steps done.
    pub iteration: u64,
    /// Named planes, row-major.
    pub planes: Vec<(String, Vec<f32>)>,
    /// Named sums.
    pub sums: Vec<(String, Vec<f64>)>,
}
