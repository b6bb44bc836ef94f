//! The outputs of a run, several at a time on the threads of its pool.
//!
//! Groups of them follow one another, each within the memory that is estimated. Outputs begin in the order of the recipe
//! and stand in it in the report; of several that fail the first counts, as if one had been made after the other.

use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::options::{Progress, Run};
use super::work::new_files;
use super::writer::Writer;
use crate::recipe::checkpoint::State;
use crate::recipe::plan::Output;
use crate::recipe::report::OutputReport;
use weald_core::error::Error;
use weald_export::Finished;

impl Run<'_> {
    /// Makes all outputs of a finished landscape, and tells notes in their order.
    pub(super) fn outputs(
        &self,
        state: &State,
        hash: &str,
        progress: &dyn Progress,
    ) -> Result<Vec<OutputReport>, Error> {
        let recipe = self.recipe;
        let finished = Finished {
            landscape: &state.landscape,
            steps: &state.steps,
            recipe: &recipe.file,
            hash,
            seed: recipe.seed,
        };
        let next_frame = |frame, frames| {
            progress.progress(frame, frames, 0);
            go_on(progress)
        };
        let device = self.options.render.as_deref();
        let writer = Writer { finished, recipe, device, next_frame: &next_frame };
        let folder = new_files(&self.options.out, recipe);
        let maker = Maker { writer: &writer, folder: &folder, outputs: &recipe.outputs, progress };
        let mut reports = Vec::with_capacity(recipe.outputs.len());
        for group in recipe.output_groups(&state.landscape) {
            let made = maker.made(group).map_err(|error| match error {
                Error::Interrupted(_) => self.stopped(state),
                other => other,
            })?;
            for report in &made {
                for note in &report.notes {
                    progress.note(&format!("{}: {note}", report.file));
                }
            }
            reports.extend(made);
        }
        Ok(reports)
    }
}

/// Ends the work where the user wants it; what is kept then is for [`Run::stopped`].
fn go_on(progress: &dyn Progress) -> Result<(), Error> {
    if progress.cancelled() { Err(Error::Interrupted(String::new())) } else { Ok(()) }
}

/// What makes the outputs of a run.
struct Maker<'a> {
    writer: &'a Writer<'a>,
    folder: &'a Path,
    outputs: &'a [Output],
    progress: &'a dyn Progress,
}

impl Maker<'_> {
    /// Makes a group side by side.
    fn made(&self, group: Range<usize>) -> Result<Vec<OutputReport>, Error> {
        let (next, failed) = (Mutex::new(group.clone()), AtomicUsize::new(usize::MAX));
        let tasks = group.into_par_iter().with_max_len(1);
        let mut made: Vec<_> = tasks.filter_map(|_| self.make_next(&next, &failed)).collect();
        made.sort_by_key(|(number, _)| *number);
        made.into_iter().map(|(_, report)| report).collect()
    }

    /// Makes the next output of a group, unless one before it has failed.
    fn make_next(
        &self,
        next: &Mutex<Range<usize>>,
        failed: &AtomicUsize,
    ) -> Option<(usize, Result<OutputReport, Error>)> {
        let number = {
            let mut next = next.lock().unwrap_or_else(PoisonError::into_inner);
            let number = next.next().filter(|&number| number < failed.load(Ordering::Relaxed))?;
            self.progress.output(number + 1, self.outputs.len(), &self.outputs[number].file);
            number
        };
        let report =
            go_on(self.progress).and_then(|()| self.writer.write(&self.outputs[number], self.folder));
        if report.is_err() {
            failed.fetch_min(number, Ordering::Relaxed);
        }
        Some((number, report))
    }
}
