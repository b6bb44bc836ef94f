//! What shapes terrain in **Weald**: generators, combinations, erosion by water and gravity, painting, analysis.
//!
//! [`generate`] makes ground from nothing, [`combine`] a layer from layers, [`erode`] lets water and gravity carve,
//! [`analyse`] reads what the land means for water, light and plants, and [`edit`] changes a landscape by hand while it
//! is simulated. One file a method, each with its equation and source. The stages never import each other.

pub mod analyse;
mod catmull_rom;
pub mod combine;
pub mod edit;
pub mod erode;
mod exponential;
pub mod flow;
pub mod generate;
