//! Engines, and what a running step knows of the world: seed, engine, progress, interruption, checkpoints.

mod budget;
mod cpu;
pub mod device;
pub mod device_machine;
mod device_tiles;
pub mod generator;
pub mod machine;
pub mod on_device;
pub mod program;
pub mod report;
pub mod stencil;
pub mod step;
mod tiles;
pub mod uniform;
pub mod world;

pub use budget::{Budget, SolidBudget, WaterBudget};

use std::sync::Arc;

use device::{Device, ShownGround};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;

/// Where and how simulations run. On all but devices the bits of the result do not depend on it.
#[derive(Clone, Debug, Default)]
pub enum Engine {
    /// All threads of the current rayon pool, in shared memory.
    #[default]
    Cpu,
    /// The domain cut into this many bands that own their memory and exchange halos by messages: what a
    /// cluster's ranks do, without a cluster.
    Bands(usize),
    /// The domain cut into tiles of up to this many columns and rows, one after the other: what a device
    /// does whose memory is too small, without a device.
    Tiles(Size),
    /// A device; an error where it fails.
    Device(Arc<dyn Device>),
    /// A device, and the CPU from the last checkpoint on where it fails.
    DeviceElseCpu(Arc<dyn Device>),
}

impl Engine {
    /// Name in the report.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Bands(_) => "bands",
            Self::Tiles(_) => "tiles",
            Self::Device(_) | Self::DeviceElseCpu(_) => "gpu",
        }
    }

    /// Tells a device where the ground of the next simulation lies.
    pub fn shows(&self, ground: &ShownGround<'_>) -> Result<(), Error> {
        match self {
            Self::Device(device) | Self::DeviceElseCpu(device) => device.shows(ground),
            _ => Ok(()),
        }
    }

    /// The adapter in the report.
    pub fn adapter(&self) -> Option<String> {
        match self {
            Self::Device(device) | Self::DeviceElseCpu(device) => Some(device.adapter()),
            _ => None,
        }
    }
}

/// What a step is given beside the landscape.
pub struct Job<'a> {
    /// Seed of this step.
    pub seed: u64,
    /// Where simulations run.
    pub engine: Engine,
    /// Hears of progress, keeps checkpoints, says when to stop.
    pub watcher: &'a dyn Watcher,
    /// State to go on from, where this step was interrupted before.
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
