//! What a run is told, and what it tells.

use crate::recipe::cache::Cache;
use crate::recipe::plan::Recipe;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use weald_core::landscape::Landscape;
use weald_engine::Engine;
use weald_engine::report::StepReport;
use weald_picture::RenderDevice;

/// How a recipe is run. None of it changes the result.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of the files, which is made where it is missing.
    pub out: PathBuf,
    /// Where simulations run.
    pub engine: Engine,
    /// Threads; all cores where none are given.
    pub threads: Option<usize>,
    /// Time between checkpoints. One of a landscape that no process holds takes its layers and the state once more on the disk
    /// of the output folder, and twice while the next is written.
    pub checkpoint_every: Duration,
    /// Whether to go on from the checkpoint in the folder.
    pub resume: bool,
    /// Whether `report.json` is written beside the outputs.
    pub report: bool,
    /// Most memory that a run may take, in bytes; all that is free where none is given.
    pub memory: Option<u64>,
    /// Folder for the layers of a run that keeps them on disk, within that memory; all in memory where none is given.
    pub out_of_core: Option<PathBuf>,
    /// Whether each of the ranks holds its own rows of the landscape alone, in memory or, out of core, on disk. All of them
    /// call [`Run::execute`] then, within the memory that each may take.
    pub distributed: bool,
    /// Results of steps that earlier runs have left, and that this one leaves.
    pub cache: Option<Arc<Cache>>,
    /// Folder in which the run leaves what its steps and outputs took, for estimates.
    pub timings: Option<PathBuf>,
    /// What draws the pictures of kind `render`.
    pub render: Option<Arc<dyn RenderDevice>>,
}

impl Options {
    /// On all cores into a folder, with a checkpoint every minute.
    pub fn into_folder(out: impl Into<PathBuf>) -> Self {
        let checkpoint_every = Duration::from_mins(1);
        Self {
            out: out.into(),
            engine: Engine::Cpu,
            threads: None,
            checkpoint_every,
            resume: false,
            report: true,
            memory: None,
            out_of_core: None,
            distributed: false,
            cache: None,
            timings: None,
            render: None,
        }
    }

    /// From a folder for layers on disk, with a checkpoint where the run is ended early alone: its size is that of the disk.
    pub fn from_disk(out: impl Into<PathBuf>, scratch: impl Into<PathBuf>) -> Self {
        let (checkpoint_every, out_of_core) = (Duration::MAX, Some(scratch.into()));
        Self { checkpoint_every, out_of_core, ..Self::into_folder(out) }
    }
}

/// Receives the progress of a run, and says when to stop. Every method has a default that does nothing.
pub trait Progress: Sync {
    /// Step `number` of `count`, counted from 1, begins.
    fn step(&self, number: usize, count: usize, name: &str) {
        let _ = (number, count, name);
    }

    /// The step has done `done` of `total` iterations over `cells` cells each.
    fn progress(&self, done: u64, total: u64, cells: usize) {
        let _ = (done, total, cells);
    }

    /// All steps are done: what they made, and what each of them reports.
    fn made(&self, landscape: &Landscape, steps: &[StepReport]) {
        let _ = (landscape, steps);
    }

    /// Output `number` of `count`, counted from 1, is made.
    fn output(&self, number: usize, count: usize, file: &Path) {
        let _ = (number, count, file);
    }

    /// Something that the user should know.
    fn note(&self, text: &str) {
        let _ = text;
    }

    /// Whether the user wants the run to end.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Progress that nobody receives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}

/// A recipe about to be run.
#[derive(Debug)]
pub struct Run<'a> {
    /// What to do.
    pub recipe: &'a Recipe,
    /// How.
    pub options: Options,
}
