//! Recipes, from text to files: [`source`] as written, [`Recipe`] as checked, [`Run`] as done.
//!
//! [`parameter`] declares the parameters of a step, [`catalog`] lists the steps, and [`schema`], [`describe`]
//! and [`template`] tell people and editors about them.

mod cache;
mod canonical;
pub mod catalog;
mod checkpoint;
pub mod describe;
mod estimate;
pub mod format;
mod fractal;
mod ground;
mod layer_file;
mod layer_output;
pub mod load;
mod memory;
mod migrate;
mod on_disk;
mod over_ranks;
mod overrides;
mod plan;
pub mod renamed;
mod report;
mod run;
mod run_steps;
mod run_to;
pub mod schema;
mod session;
pub mod template;
#[cfg(test)]
mod testing;
mod timings;
mod view_request;
mod written_layers;

pub use cache::{Cache, CacheLimits};
pub use checkpoint::{CHECKPOINT_FILE, pack_landscape, unpack_landscape};
pub use estimate::{Estimate, Machine};
pub use fractal::FractalRequest;
pub use memory::Memory;
pub use migrate::{Migrated, migrate};
pub use over_ranks::take_part;
pub use overrides::Overrides;
pub use plan::{
    BuiltIn, Content, FILM_EXTENSIONS, Film, FilmKeys, FractalKeys, FractalSource, Ground, LandscapeKeys,
    MaterialKeys, Motion, Output, OutputKeys, Planned, PlannedFractal, PlannedMaterial, PlantRole, Recipe,
};
pub use report::{OutputReport, REPORT_FILE, Report};
pub use run::{Frames, Options, Outlook, Progress, Run, Silent};
pub use run_steps::run_steps;
pub use session::{Session, SessionOptions};
pub use timings::Timings;
pub use view_request::ViewRequest;
pub use weald_core::{parameter, source};
pub use weald_engine::report::{BudgetReport, SolidReport, StepReport, WaterReport};
pub use weald_io::memory::available as free_memory;
