//! Planes of the state of models with four outflows a cell.

pub(crate) use super::state_planes::{CHANGE, DEPTH, SEDIMENT};
/// Outflow to the east.
pub(crate) const EAST: usize = 3;
/// Outflow to the west.
pub(crate) const WEST: usize = 4;
/// Outflow to the south.
pub(crate) const SOUTH: usize = 5;
/// Outflow to the north.
pub(crate) const NORTH: usize = 6;
/// Number of state planes.
pub(crate) const COUNT: usize = 7;
