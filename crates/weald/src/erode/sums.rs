//! What a simulation counts on every row, in cells³.

/// Rain that fell, as it changed the depths.
pub(crate) const RAINED: usize = 0;
/// Evaporation, negative.
pub(crate) const EVAPORATED: usize = 1;
/// Deposit that the deposit ratio took out.
pub(crate) const SHRUNK: usize = 2;
/// Water that left over an open edge.
pub(crate) const WATER_OUT: usize = 3;
/// Sediment that left over an open edge.
pub(crate) const SEDIMENT_OUT: usize = 4;
