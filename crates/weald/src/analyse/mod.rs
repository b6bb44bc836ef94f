//! Reading the land: layers of what its shape means for water, light and plants, and measures of ground and water.
//!
//! Each step of [`Stage::Analyse`](crate::step::Stage::Analyse) stands in a file of its name and says unit and range
//! of what it writes.

pub mod aspect;
mod cells;
mod component;
pub mod contour;
pub mod curvature;
mod gaussian;
mod horizon;
mod latitude;
pub mod network;
pub mod network_step;
pub mod occlusion;
mod priority_flood;
mod quadric;
pub mod select;
mod sky;
pub mod slope;
pub mod soil;
mod sun;
pub mod sunlight;
