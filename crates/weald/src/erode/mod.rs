//! Processes that shape ground: water in virtual pipes, sediment, gravity. One file a method.
//!
//! [`hydraulic`] is rain and rivers by either of two schemes, [`thermal_step`] gravity alone; [`thermal`] has the
//! schemes of weathering that both use. Within a process lengths are in cells and time is in steps; rows of cells
//! stream through its stages, so that several steps pass through memory at once.

mod advection;
mod han;
pub mod hydraulic;
mod links;
mod mei;
mod mei_kernels;
mod pipes;
mod settling;
mod simulation;
mod sums;
pub mod thermal;
pub mod thermal_step;
mod upwind;
mod working;
