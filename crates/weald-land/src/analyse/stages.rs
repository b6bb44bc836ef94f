//! The progress of an analysis that has some stages, between which it can be ended.

use weald_core::error::Error;
use weald_engine::Job;

/// How many stages of an analysis are done.
pub(super) struct Stages<'a> {
    job: &'a Job<'a>,
    done: u64,
    all: u64,
    cells: usize,
}

impl<'a> Stages<'a> {
    /// None of so many, each over so many cells.
    pub(super) fn of(job: &'a Job<'a>, all: u64, cells: usize) -> Self {
        Self { job, done: 0, all, cells }
    }

    /// One more is done.
    ///
    /// # Errors
    /// [`Error::Interrupted`] where the user ends the run.
    pub(super) fn passed(&mut self) -> Result<(), Error> {
        self.done += 1;
        self.job.watcher.progress(self.done, self.all, self.cells);
        if self.job.watcher.cancelled() { Err(Error::Interrupted(String::new())) } else { Ok(()) }
    }
}
