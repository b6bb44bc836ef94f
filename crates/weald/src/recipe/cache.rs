//! Results of steps, kept by all that they depend on: a change runs again from the changed step only.
//!
//! A result is found by a text that names what made it: the version of the program, the engine, the step with its keys and
//! its seed, the contents of the files that it reads, the grid, and of each layer that it reads what that follows from. So
//! a step that does not read what has changed is not run again. Only what a step changes is kept. In memory the layers are
//! those of the landscape; on disk a result is a checkpoint, whose text and hash are compared when it is read, so that a
//! damaged one, or one of something else, counts as none.

mod disk;
mod follows;
mod kept;
mod kept_steps;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use weald_core::error::Error;

use kept::Kept;
pub(super) use kept_steps::KeptSteps;

/// Bytes that are read from a disk in a second, or thereabouts.
const BYTES_A_SECOND: f64 = 4e8;

/// How much is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CacheLimits {
    /// Bytes in memory.
    pub memory: u64,
    /// Bytes on disk.
    pub disk: u64,
}

impl Default for CacheLimits {
    /// A gigabyte in memory, four on disk.
    fn default() -> Self {
        Self { memory: 1 << 30, disk: 4 << 30 }
    }
}

/// Results of steps, in memory and in a folder; what was used longest ago goes where the limits are reached.
#[derive(Debug)]
pub struct Cache {
    limits: CacheLimits,
    folder: Option<PathBuf>,
    memory: Mutex<Memory>,
    /// Bytes that are read again in the time in which a step must not have run to be worth keeping.
    bytes_a_second: f64,
}

#[derive(Debug, Default)]
struct Memory {
    /// Results, with the time of their last use.
    results: BTreeMap<String, (u64, Kept)>,
    bytes: u64,
    now: u64,
}

impl Cache {
    /// In memory alone.
    pub fn in_memory(bytes: u64) -> Self {
        Self::new(None, CacheLimits { memory: bytes, disk: 0 })
    }

    /// In memory, and in a folder that is made when something is kept.
    pub fn in_folder(folder: impl Into<PathBuf>, limits: CacheLimits) -> Self {
        Self::new(Some(folder.into()), limits)
    }

    fn new(folder: Option<PathBuf>, limits: CacheLimits) -> Self {
        Self { limits, folder, memory: Mutex::default(), bytes_a_second: BYTES_A_SECOND }
    }

    /// The same that keeps results of steps too that run as quickly as their results are read.
    #[must_use]
    pub fn keeping_all(self) -> Self {
        Self { bytes_a_second: f64::INFINITY, ..self }
    }

    /// Whether a result that took so long is worth keeping.
    fn is_worth(&self, kept: &Kept) -> bool {
        kept.report.seconds * self.bytes_a_second >= kept.bytes() as f64
    }

    /// Bytes that results take in memory.
    pub fn bytes_in_memory(&self) -> u64 {
        self.memory().bytes
    }

    /// A panic elsewhere leaves it whole: entries are put in and taken out one by one.
    fn memory(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The result that was kept under a text.
    fn get(&self, text: &str) -> Option<Kept> {
        if let Some(kept) = self.memory().used(text) {
            return Some(kept);
        }
        let kept = disk::read(self.folder.as_deref()?, text)?;
        self.memory().put(text, kept.clone(), self.limits.memory);
        Some(kept)
    }

    /// Keeps a result.
    ///
    /// # Errors
    /// [`Error::Run`] where it cannot be written; it is then kept in memory alone.
    fn put(&self, text: &str, kept: &Kept) -> Result<(), Error> {
        self.memory().put(text, kept.clone(), self.limits.memory);
        match &self.folder {
            Some(folder) if kept.bytes() <= self.limits.disk => {
                disk::write(folder, text, kept, self.limits.disk)
            }
            _ => Ok(()),
        }
    }
}

impl Memory {
    fn used(&mut self, text: &str) -> Option<Kept> {
        self.now += 1;
        let (time, kept) = self.results.get_mut(text)?;
        *time = self.now;
        Some(kept.clone())
    }

    fn put(&mut self, text: &str, kept: Kept, limit: u64) {
        let bytes = kept.bytes();
        self.drop_result(text);
        if bytes > limit {
            return;
        }
        while self.bytes + bytes > limit {
            let oldest = self.results.iter().min_by_key(|(_, (time, _))| *time).map(|(text, _)| text.clone());
            let Some(oldest) = oldest else { break };
            self.drop_result(&oldest);
        }
        self.now += 1;
        self.bytes += bytes;
        self.results.insert(text.to_owned(), (self.now, kept));
    }

    fn drop_result(&mut self, text: &str) {
        if let Some((_, kept)) = self.results.remove(text) {
            self.bytes -= kept.bytes();
        }
    }
}
