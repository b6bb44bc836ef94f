//! An open device: which one, what it allows, how much of its memory is held, and what goes wrong on it.

mod adapter;
mod advice;
pub(crate) mod budget;
pub(crate) mod context;
mod faults;
mod handle;
mod known;
mod waiting;

pub use handle::Gpu;
pub(crate) use handle::{Shown, Shows};
pub use waiting::Suspension;
