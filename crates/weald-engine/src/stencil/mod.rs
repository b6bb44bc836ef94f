//! Stencils over rows: kernels, rows in flight, and streams of rows that fuse and block a simulation.

pub mod chain;
pub mod kernel;
pub mod ring;
pub mod rows;
pub mod segment;
