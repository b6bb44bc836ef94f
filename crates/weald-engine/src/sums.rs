//! Sums that a simulation keeps, so that budgets can be drawn up.

/// Sums that a process keeps for each row, in the process's own order.
pub const SUMS: usize = 5;

/// What happened on one row, summed over its cells and over time.
pub type RowSums = [f64; SUMS];
