//! What is averaged over the recorded steps of a simulation.

/// A plane that counts into a mean.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Number of the plane.
    pub plane: usize,
    /// Factor that it counts with.
    pub factor: f32,
    /// Cells east and south of a cell, at most 1, where its value is taken from; beyond the edge it is 0.
    pub from: [usize; 2],
}

/// Parts of each mean.
pub type Means<'a> = &'a [&'a [Part]];
