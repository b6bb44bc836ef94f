//! The device against the CPU, its limits, and the renderer, on Vulkan.

mod budgets;
mod choice;
#[path = "../../../weald-land/tests/land/common/mod.rs"]
mod common;
mod counting;
mod device;
mod edits;
mod engines_agree;
mod figures;
mod flip;
mod followed;
mod goldens;
mod grass;
mod horizon;
mod larger_than_memory;
mod limits;
mod live;
mod marched;
mod plants;
mod processes;
mod programs;
mod render;
mod reprojection;
mod rounding;
mod scenes;
mod sessions;
mod suspended;
mod swarms;
mod tables;
mod transitions;
mod window;
mod woods;
