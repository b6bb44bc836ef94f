//! What a simulation asks of an engine, whatever the engine.

use crate::stencil::rows::Rows;
use crate::sums::RowSums;
use weald_core::error::Error;
use weald_core::grid::Size;

/// The running state of a simulation on some engine.
pub trait Machine<W> {
    /// Fewest steps that are worth one call of [`Machine::advance`].
    fn block(&self) -> usize;

    /// One step for each entry of `weather`; where `recorded`, each counts into the means.
    fn advance(&mut self, weather: &[W], recorded: bool) -> Result<(), Error>;

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

    /// Columns and rows.
    pub fn size(&self) -> Size {
        Size { columns: self.state.layout.columns, rows: self.state.count() }
    }
}

/// A plane that counts into a mean.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Number of the plane.
    pub plane: usize,
    /// Factor that it counts with.
    pub factor: f32,
    /// Cells east and south of a cell where its value is taken from; beyond the edge it is 0.
    pub from: [usize; 2],
}

/// Parts of each mean.
pub type Means<'a> = &'a [&'a [Part]];
