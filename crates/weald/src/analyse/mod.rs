//! Measures of ground and water.

mod component;
pub mod contour;
mod gaussian;
pub mod network;
mod priority_flood;
