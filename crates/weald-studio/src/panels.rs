//! The parts of the window, one file each.

pub(crate) mod arranged;
pub(crate) mod brush;
pub(crate) mod cameras;
pub(crate) mod controls;
mod export;
pub(crate) mod files;
pub(crate) mod histogram;
pub(crate) mod history;
pub(crate) mod legend;
pub(crate) mod looks;
pub(crate) mod marks;
pub(crate) mod masked;
pub(crate) mod overlay;
pub(crate) mod palette;
mod pictures;
pub(crate) mod section;
pub(crate) mod seeds;
pub(crate) mod simulation;
pub(crate) mod start;
pub(crate) mod status;
mod step_pictures;
pub(crate) mod steps;
pub(crate) mod text;
pub(crate) mod toolbar;
