//! Progress on the standard error output of the first rank: lines, since what a cluster runs is read in files.

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use weald::recipe::Progress;

use crate::interrupt;

/// Time between two lines.
const LINE_EVERY: Duration = Duration::from_secs(5);

/// Tells where the run is.
pub(crate) struct Lines {
    quiet: bool,
    /// What runs, since when it was told.
    now: Mutex<(String, Instant)>,
}

impl Lines {
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet, now: Mutex::new((String::new(), Instant::now())) }
    }

    fn begin(&self, title: String) {
        if !self.quiet {
            eprintln!("{title}");
        }
        // A panic elsewhere leaves it whole, since it is only ever replaced.
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = (title, Instant::now());
    }
}

impl Progress for Lines {
    fn step(&self, number: usize, count: usize, name: &str) {
        self.begin(format!("step {number}/{count} {name}"));
    }

    fn progress(&self, done: u64, total: u64, _: usize) {
        let mut now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.quiet && now.1.elapsed() >= LINE_EVERY {
            now.1 = Instant::now();
            eprintln!("{} {done}/{total}", now.0);
        }
    }

    fn output(&self, number: usize, count: usize, file: &Path) {
        self.begin(format!("file {number}/{count} {}", file.display()));
    }

    fn note(&self, text: &str) {
        if !self.quiet {
            eprintln!("note: {text}");
        }
    }

    fn cancelled(&self) -> bool {
        interrupt::asked()
    }
}
