//! Where a simulation on a stored landscape is between two of its passes, so that another run can go on from there.

use crate::stored_plane::StoredPlane;
use crate::sums::RowSums;

/// The whole state of a simulation, of which this process has its own rows.
#[derive(Debug)]
pub struct StoredState<'a> {
    /// Steps done.
    pub iteration: u64,
    /// Name, unit and values of the layer that the simulation has taken out of the landscape, as it was at the start.
    pub taken: (&'a str, &'a str, &'a StoredPlane),
    /// Named planes, all of one grid.
    pub planes: Vec<(String, &'a StoredPlane)>,
    /// Sums of each of its own rows of that grid.
    pub row_sums: &'a [RowSums],
}

/// The same as it comes back; the layer is in the landscape again.
#[derive(Debug, Default)]
pub struct ResumedState {
    /// Steps done.
    pub iteration: u64,
    /// Named planes.
    pub planes: Vec<(String, StoredPlane)>,
    /// Sums of each of its own rows.
    pub row_sums: Vec<RowSums>,
}
