//! Sums that a simulation keeps: of each row, so that budgets can be drawn up, and of steps, for means.

/// Sums that a process keeps for each row, in the process's own order.
pub const SUMS: usize = 5;

/// What happened on one row, summed over its cells and over time.
pub type RowSums = [f64; SUMS];

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
