//! A stroke of a brush before an iteration of a simulation.

use super::brush::Brush;

/// A stroke, and the iteration before which it happens.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// Iterations of the simulation that are done before it; 0 for none.
    pub step: u64,
    /// The stroke.
    pub brush: Brush,
}
