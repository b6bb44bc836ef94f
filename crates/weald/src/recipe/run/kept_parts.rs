//! Checkpoints of a run whose landscape no process holds as a whole: when they are kept, and how a run goes on from one. All
//! ranks come here together.

use std::sync::Mutex;

use super::ground_in_parts;
use super::options::{Progress, Run};
use super::step_watcher::{CheckpointTimer, locked, note_failure};
use crate::ground_file::GroundRows;
use crate::recipe::checkpoint::{KeptParts, Manifest};
use weald_core::error::Error;
use weald_engine::Watcher;
use weald_engine::ranks::{agreed, any};
use weald_engine::report::StepReport;
use weald_engine::stored::StoredLandscape;
use weald_engine::stored_state::StoredState;

/// How far a run has come.
#[derive(Default)]
pub(super) struct SoFar {
    /// What the steps done have to report.
    pub(super) steps: Vec<StepReport>,
    /// What there is to say of the input.
    pub(super) notes: Vec<String>,
}

impl SoFar {
    /// Steps done.
    pub(super) fn done(&self) -> usize {
        self.steps.len()
    }
}

/// The watcher of one step.
pub(super) struct PartsWatcher<'a> {
    run: &'a Run<'a>,
    pub(super) so_far: &'a SoFar,
    pub(super) progress: &'a dyn Progress,
    clock: &'a CheckpointTimer,
    /// The iteration of the last checkpoint.
    kept: Mutex<Option<u64>>,
}

impl<'a> PartsWatcher<'a> {
    pub(super) fn new(
        run: &'a Run<'a>,
        so_far: &'a SoFar,
        (progress, clock): (&'a dyn Progress, &'a CheckpointTimer),
    ) -> Self {
        Self { run, so_far, progress, clock, kept: Mutex::new(None) }
    }
}

impl Watcher for PartsWatcher<'_> {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.progress.progress(done, total, cells);
    }

    fn cancelled(&self) -> bool {
        self.progress.cancelled()
    }

    fn checkpoint_due(&self) -> bool {
        self.clock.is_due()
    }

    fn keep(&self, landscape: &StoredLandscape<'_>, state: &StoredState<'_>) -> Result<(), Error> {
        if self.run.keep_parts(landscape, (self.so_far, Some(state)), (self.progress, self.clock))? {
            *locked(&self.kept) = Some(state.iteration);
        }
        Ok(())
    }
}

impl Run<'_> {
    fn write_parts(
        &self,
        landscape: &StoredLandscape<'_>,
        (so_far, state): (&SoFar, Option<&StoredState<'_>>),
    ) -> Result<(), Error> {
        let (recipe, SoFar { steps, notes }) = (self.recipe.effective(), so_far);
        KeptParts { recipe, steps, notes, landscape, state }.write(&self.options.out)
    }

    /// Keeps a checkpoint; gives whether it was written. One that cannot be is told, unless the run is to end with it.
    fn keep_parts(
        &self,
        landscape: &StoredLandscape<'_>,
        kept: (&SoFar, Option<&StoredState<'_>>),
        (progress, clock): (&dyn Progress, &CheckpointTimer),
    ) -> Result<bool, Error> {
        let written = self.write_parts(landscape, kept);
        clock.restart();
        let done = note_failure(written, progress);
        // Of a signal that has come to some ranks alone the others hear here.
        agreed(&*landscape.ranks, done)
    }

    /// Begins, or goes on from a checkpoint.
    pub(super) fn start_in_parts(
        &self,
        landscape: &mut StoredLandscape<'_>,
        ground: Option<&GroundRows>,
        progress: &dyn Progress,
    ) -> Result<SoFar, Error> {
        let path = self.checkpoint();
        if !self.options.resume {
            if landscape.ranks.leads() && weald_core::files::exists(&path) {
                let path = path.display();
                progress.note(&format!("starting anew; the checkpoint {path} is used with --resume only"));
            }
            let Some(ground) = ground else { return Ok(SoFar::default()) };
            landscape.want(self.recipe.wanted_after(0));
            ground_in_parts::read(ground, landscape)?;
            ground.notes.iter().for_each(|note| progress.note(note));
            return Ok(SoFar { notes: ground.notes.clone(), ..SoFar::default() });
        }
        let ranks = landscape.ranks.clone();
        let read = || Manifest::to_go_on(&self.options.out, self.recipe.effective(), landscape.domain.size);
        let manifest = agreed(&*ranks, if ranks.leads() { read().map(Some) } else { Ok(None) })?;
        let manifest = Manifest::told(manifest, &*ranks)?;
        landscape.want(self.recipe.wanted_after(manifest.steps.len()));
        manifest.load(&self.options.out, landscape)?;
        let (done, iterations) = (manifest.steps.len(), manifest.iteration.unwrap_or_default());
        progress.note(&format!("going on after {done} steps and {iterations} iterations"));
        Ok(SoFar { steps: manifest.steps, notes: manifest.notes })
    }

    /// Keeps the layers between two steps where it is time for it, and where the run is to end.
    pub(super) fn keep_between_steps(
        &self,
        landscape: &StoredLandscape<'_>,
        so_far: &SoFar,
        (progress, clock): (&dyn Progress, &CheckpointTimer),
    ) -> Result<(), Error> {
        let ranks = &*landscape.ranks;
        let ends = any(ranks, progress.cancelled())?;
        if !any(ranks, ends || clock.is_due())? {
            return Ok(());
        }
        self.keep_parts(landscape, (so_far, None), (progress, clock))?;
        if !ends {
            return Ok(());
        }
        Err(self.interrupted(&format!("after {} of {} steps", so_far.done(), self.recipe.steps.len())))
    }

    /// Says in which step an error arose, and where the last state is. What was interrupted without one starts again.
    pub(super) fn explain_in_parts(
        &self,
        error: Error,
        landscape: &StoredLandscape<'_>,
        watcher: &PartsWatcher<'_>,
    ) -> Error {
        let done = watcher.so_far.done();
        let step = format!("step {} (`{}`)", done + 1, self.recipe.steps[done].entry.name);
        let kept = *locked(&watcher.kept);
        let is_stopped = are_all(landscape, matches!(error, Error::Interrupted(_)));
        match (error, kept) {
            (Error::Interrupted(_), Some(iteration)) => {
                self.interrupted(&format!("in {step} after {iteration} iterations"))
            }
            (Error::Interrupted(_), None) if is_stopped => {
                match self.write_parts(landscape, (watcher.so_far, None)) {
                    Ok(()) => self.interrupted(&format!("in {step}, which will start again")),
                    Err(error) => error,
                }
            }
            (other, kept) => self.in_step(other, (&step, self.recipe.steps[done].entry.name), kept),
        }
    }

    /// Keeps what the steps made when a file cannot be written, so that the run can go on when there is room again.
    pub(super) fn with_rows_kept(
        &self,
        error: Error,
        landscape: &StoredLandscape<'_>,
        so_far: &SoFar,
    ) -> Error {
        let error = self.by_its_name(error);
        if !are_all(landscape, matches!(error, Error::Run(_) | Error::Interrupted(_))) {
            return error;
        }
        let path = self.checkpoint();
        let path = path.display();
        let kept = self.write_parts(landscape, (so_far, None)).is_ok();
        match error {
            Error::Run(what) if kept => Error::Run(format!(
                "{what}; no file has changed, and the same command with --resume goes on from {path}"
            )),
            Error::Run(what) => {
                Error::Run(format!("{what}; no file has changed, nor was there room for a checkpoint"))
            }
            _ if kept => self.interrupted("when all steps were done"),
            _ => Error::Interrupted(
                "interrupted; no file has changed, and no checkpoint could be written".to_owned(),
            ),
        }
    }
}

/// Whether something is so on all ranks: an error of one may be another there, and a checkpoint is written by all or by none.
fn are_all(landscape: &StoredLandscape<'_>, own: bool) -> bool {
    any(&*landscape.ranks, !own).is_ok_and(|differs| !differs)
}
