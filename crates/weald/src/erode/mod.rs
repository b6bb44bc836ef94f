//! Processes that shape ground: water in virtual pipes, sediment, gravity. One file a method.

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
