//! Planes of the state of the models of water.

/// Change of the ground since the start.
pub(crate) const CHANGE: usize = 0;
/// Depth of water.
pub(crate) const DEPTH: usize = 1;
/// Sediment in the water.
pub(crate) const SEDIMENT: usize = 2;
/// Outflow to the east, of models with four outflows a cell.
pub(crate) const EAST: usize = 3;
/// Outflow to the west.
pub(crate) const WEST: usize = 4;
/// Outflow to the south.
pub(crate) const SOUTH: usize = 5;
/// Outflow to the north.
pub(crate) const NORTH: usize = 6;
/// Number of state planes of these models.
pub(crate) const COUNT: usize = 7;
