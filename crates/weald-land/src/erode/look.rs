//! Looks at the landscape of a running simulation, for films and for whoever watches.

use super::finished::Finished;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_engine::Watcher;
use weald_engine::machine::{Means, Part, Snapshot};
use weald_engine::stencil::chain::RowSums;
use weald_engine::stencil::rows::Rows;

/// What a state looks like as a landscape.
pub(crate) type Seen<'a> = &'a dyn Fn(&Finished) -> Result<Landscape, Error>;

impl Finished {
    /// A state as if the simulation ended with it; its means are those of the moment.
    pub(super) fn of_moment(snapshot: Snapshot, means: Means<'_>) -> Self {
        let Snapshot { state, row_sums, .. } = snapshot;
        let means = means.iter().map(|parts| moment(&state, parts)).collect();
        Self { state, sums: total(&row_sums), means, notes: Vec::new() }
    }
}

/// Shows a state to the watcher, if it wants to look after `done` steps.
pub(super) fn show(
    watcher: &dyn Watcher,
    done: u64,
    finished: impl FnOnce() -> Result<Finished, Error>,
    seen: Option<Seen<'_>>,
) -> Result<(), Error> {
    match seen {
        Some(seen) if watcher.next_look(done) == Some(done) => watcher.look(done, &seen(&finished()?)?),
        _ => Ok(()),
    }
}

/// Sums of all rows, from north to south.
pub(super) fn total(row_sums: &[RowSums]) -> RowSums {
    let mut sums = RowSums::default();
    for row in row_sums {
        sums.iter_mut().zip(row).for_each(|(total, sum)| *total += sum);
    }
    sums
}

fn moment(state: &Rows, parts: &[Part]) -> Vec<f32> {
    let size = Size { columns: state.layout.columns, rows: state.count() };
    let mut sum = vec![0.0; size.cells()];
    for part in parts {
        let (plane, [east, south]) = (state.gather(part.plane), part.from);
        for (cell, sum) in sum.iter_mut().enumerate() {
            let (x, y) = (cell % size.columns + east, cell / size.columns + south);
            if x < size.columns && y < size.rows {
                *sum += part.factor * plane[size.index(x, y)];
            }
        }
    }
    sum
}
