//! Planes with which the state of all models of water begins.

/// Change of the ground since the start.
pub(crate) const CHANGE: usize = 0;
/// Depth of water.
pub(crate) const DEPTH: usize = 1;
/// Sediment in the water.
pub(crate) const SEDIMENT: usize = 2;
