//! The machine of the first rank: it does what the simulation asks for on its own rows, and tells the others to do so.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::band::{self, Band};
use super::bytes::{Reader, Writer};
use super::command::{Command, Start};
use super::messages::Ranks;
use super::share::Share;
use crate::device::Window;
use crate::machine::{Machine, Means, Snapshot, never_kept};
use crate::patch::{Patch, Patched};
use crate::stencil::chain::Process;
use crate::stencil::rows::{Layout, Rows};
use crate::uniform::Uniform;
use weald_core::error::Error;

/// A simulation over ranks.
pub(crate) struct RanksMachine<P: Process> {
    ranks: Arc<dyn Ranks>,
    process: Arc<P>,
    means: Means<'static>,
    band: Band<P>,
    rows: usize,
    /// Copies by their numbers, whole and here.
    copies: BTreeMap<u64, Snapshot>,
}

impl<P: Process> RanksMachine<P> {
    /// Begins the simulation on all ranks, each of which is in [`follow`](super::follow).
    pub(crate) fn new(
        process: &Arc<P>,
        means: Means<'static>,
        start: &Snapshot,
        ranks: &Arc<dyn Ranks>,
    ) -> Result<Self, Error> {
        let band = begin(process, means, start, ranks)?;
        let (ranks, process, rows) = (Arc::clone(ranks), Arc::clone(process), start.state.count());
        Ok(Self { ranks, process, means, band, rows, copies: BTreeMap::new() })
    }

    fn tell(&self, command: &Command) -> Result<(), Error> {
        self.ranks.tell(command.message()).map(drop)
    }

    /// Begins anew from a state.
    fn begin_again(&mut self, state: &Snapshot) -> Result<(), Error> {
        self.band = begin(&self.process, self.means, state, &self.ranks)?;
        Ok(())
    }
}

/// Deals a state to all ranks; gives the part of this one.
fn begin<P: Process>(
    process: &Arc<P>,
    means: Means<'static>,
    state: &Snapshot,
    ranks: &Arc<dyn Ranks>,
) -> Result<Band<P>, Error> {
    let (layout, rows) = (state.state.layout, state.state.count());
    let start = Start { layout, rows, process: described(&**process) };
    ranks.tell(Command::Begin(start).message())?;
    let share = Share::of((0, ranks.count()), rows, process.reach());
    let part = ranks.deal(&mut |rank| band::deal(state, &share.of_rank(rank)))?;
    Band::new(&**process, means, (share, layout), &part, ranks)
}

/// What must be the same on all ranks of a process, in words.
pub(super) fn described<P: Process>(process: &P) -> String {
    let program = process.program();
    let counts = [process.state_planes(), process.constant_planes(), process.lag(), process.reach()];
    let (name, constants) = (program.name, program.constants);
    format!("{name} {counts:?} {constants:?} {:?} {:?}", program.flags, program.counts)
}

/// The place of a value that is no number, as a message.
pub(super) fn place_message(place: Option<[usize; 3]>) -> Vec<u8> {
    let mut writer = Writer::default();
    writer.counts(place.as_ref().map_or(&[], |place| place.as_slice()));
    writer.0
}

fn read_place(message: &[u8]) -> Result<Option<[usize; 3]>, Error> {
    if message.is_empty() {
        return Ok(None);
    }
    let mut reader = Reader(message);
    Ok(Some([reader.count()?, reader.count()?, reader.count()?]))
}

/// The others go on with the run when the simulation ends, however it does.
impl<P: Process> Drop for RanksMachine<P> {
    fn drop(&mut self) {
        // Where they can no longer be reached, the simulation has failed by that already.
        let _ = self.tell(&Command::End);
    }
}

impl<P: Process> Patched for RanksMachine<P> {
    fn patch(&mut self, window: &Window) -> Result<Patch, Error> {
        self.tell(&Command::Cut(window.clone()))?;
        let planes = self.band.layout().planes;
        let mut rows = Rows::new(Layout { columns: window.columns.len(), planes }, window.rows.len());
        let share = self.band.share().clone();
        self.ranks.collect(self.band.cut(window), &mut |rank, part| {
            band::take_cut(&mut rows, window, &share.of_rank(rank), &part)
        })?;
        let sums = self.band.first_sums();
        Ok(Patch { window: window.clone(), planes: (0..planes).collect(), rows, sums })
    }

    fn lay(&mut self, patch: &Patch) -> Result<(), Error> {
        self.tell(&Command::Lay(Box::new(patch.clone())))?;
        self.band.lay(patch);
        Ok(())
    }
}

impl<P: Process> Machine<P> for RanksMachine<P> {
    fn block(&self) -> usize {
        self.band.share().block
    }

    fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error> {
        let words = weather.iter().map(Uniform::words).collect();
        self.tell(&Command::Advance { recorded, weather: words })?;
        self.band.advance(weather, recorded)
    }

    fn first_not_finite(&mut self) -> Result<Option<[usize; 3]>, Error> {
        self.tell(&Command::Check)?;
        // Ranks answer from north to south, so that the first place is the first of the whole.
        let mut first = None;
        self.ranks.collect(place_message(self.band.first_not_finite()), &mut |_, message| {
            first = first.or(read_place(&message)?);
            Ok(())
        })?;
        Ok(first)
    }

    fn keep(&mut self) -> Result<(), Error> {
        self.tell(&Command::Keep)?;
        self.band.keep()
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.tell(&Command::GoBack)?;
        self.band.go_back()
    }

    fn snapshot(&mut self) -> Result<Snapshot, Error> {
        self.tell(&Command::Collect)?;
        let mut whole = Snapshot::start(Rows::new(self.band.layout(), self.rows), self.means.len());
        let share = self.band.share().clone();
        self.ranks.collect(self.band.part(), &mut |rank, part| {
            band::take(&mut whole, &share.of_rank(rank), &part)
        })?;
        Ok(whole)
    }

    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.begin_again(snapshot)
    }

    /// How far a cell feels others may change with the process, and with it who holds which rows.
    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error> {
        let state = self.snapshot()?;
        self.tell(&Command::Follow)?;
        self.process = Arc::clone(process);
        self.begin_again(&state)
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        let copy = self.snapshot()?;
        self.copies.insert(number, copy);
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        let copy = self.copies.remove(&number).ok_or_else(|| never_kept(number))?;
        self.begin_again(&copy)?;
        self.copies.insert(number, copy);
        Ok(())
    }

    fn release(&mut self, number: u64) {
        self.copies.remove(&number);
    }

    fn bytes_of_copy(&self) -> u64 {
        let (layout, cells) = (self.band.layout(), self.rows * self.band.layout().columns);
        (4 * (layout.row_length() * self.rows + self.means.len() * cells)) as u64
    }

    fn clear_means(&mut self) -> Result<(), Error> {
        self.tell(&Command::ClearMeans)?;
        self.band.clear_means()
    }
}
