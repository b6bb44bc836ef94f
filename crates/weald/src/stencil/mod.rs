//! Stencils over rows: kernels, rows in flight, and streams of rows that fuse and block a simulation.

pub(crate) mod chain;
pub(crate) mod kernel;
pub(crate) mod ring;
pub(crate) mod rows;
