//! Where and how **Weald** computes: [steps](step) and the [jobs](Job) that they are given, [stencils](stencil) over rows,
//! [programs](program) for devices, and machines for processors, bands, tiles, devices and
//! [ranks], with the same bits on each
//! processor.

pub mod bands;
mod budget;
mod cpu;
pub mod device;
pub mod device_machine;
mod device_tiles;
mod engine;
mod finest;
pub mod generator;
mod job;
pub mod local;
pub mod machine;
pub mod machine_of_engine;
pub mod on_device;
pub mod patch;
pub mod program;
pub mod ranks;
pub mod report;
pub mod served;
pub mod stencil;
pub mod step;
pub mod stored;
pub mod stored_bands;
mod stored_plane;
pub mod stored_state;
pub mod strips;
pub mod sums;
mod tiles;
pub mod uniform;

pub use budget::{Budget, SolidBudget, WaterBudget};
pub use engine::{Engine, WENT_ON_ON_CPU};
pub use job::{Job, SavedSimulation, Unwatched, Watcher};
