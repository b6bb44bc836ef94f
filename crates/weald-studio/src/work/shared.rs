//! What the one who works and the window both see.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use weald::recipe::Progress;

use super::status::{Phase, Status};

pub(super) struct Shared {
    pub(super) status: Mutex<Status>,
    /// Number of the last task that makes what is computed now needless.
    pub(super) superseded: AtomicU64,
    /// Number of the last task.
    pub(super) asked: AtomicU64,
    /// Tells the window that there is something new.
    pub(super) tell: Box<dyn Fn() + Send + Sync>,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Shared").finish_non_exhaustive()
    }
}

impl Shared {
    /// Nothing was asked yet; `tell` is called whenever the status has changed.
    pub(super) fn new(tell: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            status: Mutex::default(),
            superseded: AtomicU64::new(0),
            asked: AtomicU64::new(0),
            tell: Box::new(tell),
        }
    }

    /// Notes that a task is asked, and gives its number.
    pub(super) fn ask(&self, supersedes: bool) -> u64 {
        let number = self.asked.fetch_add(1, Ordering::AcqRel) + 1;
        if supersedes {
            self.superseded.store(number, Ordering::Release);
        }
        number
    }

    /// A status is only ever replaced part by part, so a panic elsewhere leaves it of use.
    pub(super) fn status(&self) -> MutexGuard<'_, Status> {
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes that something was asked that could not be done and left nothing to undo.
    pub(super) fn refuse(&self) {
        self.status().refused += 1;
    }

    pub(super) fn change(&self, change: impl FnOnce(&mut Status)) {
        change(&mut self.status());
        (self.tell)();
    }
}

/// Tells the window how far a run is, and ends it once something else is asked.
pub(super) struct Told<'a> {
    pub(super) shared: &'a Shared,
    pub(super) number: u64,
    pub(super) watched: &'a AtomicU64,
}

impl Progress for Told<'_> {
    fn step(&self, step: usize, count: usize, name: &str) {
        let name = name.to_owned();
        self.shared.change(|status| status.phase = Phase::Running { step, count, name, share: None });
    }

    fn progress(&self, done: u64, total: u64, _: usize) {
        self.shared.change(|status| {
            if let Phase::Running { share, .. } = &mut status.phase {
                *share = Some(done as f32 / total.max(1) as f32);
            }
        });
    }

    fn output(&self, _: usize, _: usize, file: &Path) {
        let file = file.display().to_string();
        self.shared.change(|status| status.phase = Phase::Writing(file));
    }

    fn note(&self, text: &str) {
        self.shared.change(|status| status.notes.push(text.to_owned()));
    }

    fn cancelled(&self) -> bool {
        self.watched.load(Ordering::Acquire) > self.number
    }
}
