//! What measures of a network are taken of.

use weald_core::grid::{Field, Mask};

/// Cells whose runoff makes a channel.
pub(super) const CHANNEL_AREA: f64 = 100.0;

/// A landscape at the end of a dry period.
#[derive(Clone, Copy, Debug)]
pub struct NetworkInput<'a> {
    /// Height of the ground in metres.
    pub ground: &'a Field,
    /// Height of the ground in metres before it was eroded, where it is known.
    pub before: Option<&'a Field>,
    /// Depth of water in metres.
    pub depth: &'a Field,
    /// Mean flux through the eastern face of each cell over whole rain cycles, in cell areas of cell height
    /// an iteration (the volume with cells of size 1).
    pub mean_flux_x: &'a Field,
    /// The same through the southern face.
    pub mean_flux_y: &'a Field,
    /// Mean rain over the same time, in cells per iteration.
    pub mean_rain: f64,
    /// Side of a cell in metres.
    pub cell: f64,
    /// Cells with data; `None` where all have.
    pub valid: Option<&'a Mask>,
}
