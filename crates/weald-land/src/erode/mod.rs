//! Processes that shape ground: water in virtual pipes, sediment, gravity. One file a method.
//!
//! [`hydraulic`] is rain and rivers by one of three schemes, [`thermal_step`] gravity alone; [`thermal`] has the
//! schemes of weathering that both use. [`slippage_step`] and [`dissolution_step`] are processes of the third
//! scheme alone, [`transport_step`] carries a layer by water that flows steadily. Within a process lengths are in
//! cells and time is in steps; rows of cells stream through its stages, so that several steps pass through memory
//! at once. Each process is also a program for a compute device, of shaders that stand beside its kernels.

mod advection;
mod advection_rows;
mod bare_material;
mod coarse_landscape;
pub mod coast;
#[cfg(test)]
#[path = "../../tests/worked_example/creep.rs"]
pub mod creep;
pub mod dissolution_step;
mod edits;
mod extent;
mod finished;
mod fluvial;
mod fluvial_held;
mod fluvial_levels;
mod fluvial_materials;
mod fluvial_numbers;
mod fluvial_run;
pub mod fluvial_step;
mod fluvial_years;
mod flux_corrected;
mod four_outflows;
mod han;
pub mod hydraulic;
pub mod interactive;
mod links;
mod live;
mod look;
mod loose;
mod material_planes;
mod mei;
mod on_ground;
mod outflow_kernels;
mod over_ranks;
mod pace;
mod painted_mask;
mod pipeline;
mod pipes;
mod processes;
mod programs;
mod saved;
mod scripted;
mod setting;
mod settings;
mod settling;
mod simulation;
pub mod slippage_step;
pub mod springs;
mod stack;
mod stacked_grid;
mod started;
mod stava;
mod stored;
mod stream_power;
mod stream_power_run;
pub mod stream_power_step;
mod sums;
mod sweep;
pub mod thermal;
pub mod thermal_step;
pub mod transport_step;
mod water_planes;
mod working;

pub use processes::{interactive as interactive_step, interactive_names, processes};
pub use programs::programs;

use weald_engine::stencil::ring::Ring;

/// The row before `y`, or the still row beyond the wall.
fn before<'a>(ring: &'a Ring, still: &'a Ring, y: usize, start: usize) -> &'a [f32] {
    if y > start { ring.here(y - 1) } else { still.here(0) }
}
