//! What a simulation asks of an engine, whatever the engine.

use std::sync::Arc;

use crate::device::Window;
use crate::patch::{Patch, Patched};
use crate::stencil::chain::Process;
use crate::stencil::rows::Rows;
use crate::sums::RowSums;
pub use crate::sums::{Means, Part};
use weald_core::error::Error;
use weald_core::grid::Size;

/// The running state of a simulation on some engine.
pub trait Machine<P: Process>: Patched + Send {
    /// Fewest steps that are worth one call of [`Machine::advance`].
    fn block(&self) -> usize;

    /// One step for each entry of `weather`; where `recorded`, each counts into the means.
    fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error>;

    /// Column, row and plane of the first value of the state that is a NaN or an infinity.
    fn first_not_finite(&mut self) -> Result<Option<[usize; 3]>, Error>;

    /// Keeps a copy of everything to go back to.
    fn keep(&mut self) -> Result<(), Error>;

    /// Goes back to the copy.
    fn go_back(&mut self) -> Result<(), Error>;

    /// A copy of everything.
    fn snapshot(&mut self) -> Result<Snapshot, Error>;

    /// What the user should know of how it works.
    fn note(&self) -> Option<String> {
        None
    }

    /// Replaces everything.
    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error>;

    /// Goes on by another process whose planes are the same.
    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error>;

    /// Keeps a copy of everything under a number, in place of what was kept under it; on a device there.
    fn keep_as(&mut self, number: u64) -> Result<(), Error>;

    /// Goes back to the copy that was kept under a number.
    fn return_to(&mut self, number: u64) -> Result<(), Error>;

    /// Forgets a copy.
    fn release(&mut self, number: u64);

    /// Memory that such a copy takes.
    fn bytes_of_copy(&self) -> u64;

    /// Begins the means anew.
    fn clear_means(&mut self) -> Result<(), Error>;
}

/// A copy was asked for that is not there: a bug of the caller.
pub(crate) fn never_kept(number: u64) -> Error {
    Error::Run(format!("the simulation was asked to go back to copy {number}, which was never kept"))
}

/// All that changes in a simulation, and the constant planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// State planes, and the constant planes behind them.
    pub state: Rows,
    /// Sums of each row. An engine that does not keep rows apart has all in one of them.
    pub row_sums: Vec<RowSums>,
    /// Sums over the recorded steps, row-major.
    pub means: Vec<Vec<f32>>,
}

impl Snapshot {
    /// The start of a simulation with that many means.
    pub fn start(state: Rows, means: usize) -> Self {
        let (rows, cells) = (state.count(), state.count() * state.layout.columns);
        Self { state, row_sums: vec![RowSums::default(); rows], means: vec![vec![0.0; cells]; means] }
    }

    /// Memory that it takes.
    pub fn bytes(&self) -> usize {
        let means: usize = self.means.iter().map(|mean| size_of_val(mean.as_slice())).sum();
        size_of_val(self.state.memory.as_slice()) + size_of_val(self.row_sums.as_slice()) + means
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        Size { columns: self.state.layout.columns, rows: self.state.count() }
    }
}

impl Patched for Snapshot {
    fn patch(&mut self, window: &Window) -> Result<Patch, Error> {
        let planes = self.state.layout.planes;
        Ok(Patch::cut(planes, window, self.row_sums[0], |y, plane| self.state.plane(y, plane)))
    }

    fn lay(&mut self, patch: &Patch) -> Result<(), Error> {
        patch.put(|y, plane, x, cells| {
            self.state.plane_mut(y, plane)[x..][..cells.len()].copy_from_slice(cells);
        });
        self.row_sums[0] = patch.sums;
        Ok(())
    }
}
