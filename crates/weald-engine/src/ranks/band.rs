//! The rows of one rank: advanced as a grid of their own, between exchanges of those around them.

use std::ops::Range;
use std::sync::Arc;

use super::bytes::{Reader, Writer};
use super::messages::{Ranks, Swap};
use super::share::Share;
use crate::cpu::CpuMachine;
use crate::device::Window;
use crate::machine::{Machine, Means, Snapshot};
use crate::patch::Patch;
use crate::stencil::chain::Process;
use crate::stencil::rows::{Layout, Rows};
use weald_core::error::Error;
use weald_core::grid::Size;

/// What a rank holds of a simulation.
pub(super) struct Band<P: Process> {
    ranks: Arc<dyn Ranks>,
    share: Share,
    layout: Layout,
    /// Planes that steps change: no others travel.
    state_planes: usize,
    /// Its rows and those around them; none on a rank without rows.
    machine: Option<CpuMachine<P>>,
    /// What goes to the north and the south, and what comes from there.
    given: [Vec<f32>; 2],
    taken: [Vec<f32>; 2],
}

impl<P: Process> Band<P> {
    /// The band of a share, from the part that [`deal`] made.
    pub(super) fn new(
        process: &P,
        means: Means<'static>,
        (share, layout): (Share, Layout),
        part: &[u8],
        ranks: &Arc<dyn Ranks>,
    ) -> Result<Self, Error> {
        let start = read_part(&mut Reader(part), &share, layout, means.len())?;
        // Its process has the rows around its own: with fewer, walls would stand between ranks.
        let machine = (!share.own().is_empty()).then(|| {
            let process = Arc::new(process.sized(Size { columns: layout.columns, rows: share.held().len() }));
            CpuMachine::new(&process, means, &start, None)
        });
        let (ranks, state_planes) = (Arc::clone(ranks), process.state_planes());
        Ok(Self {
            ranks,
            share,
            layout,
            state_planes,
            machine,
            given: Default::default(),
            taken: Default::default(),
        })
    }

    pub(super) fn share(&self) -> &Share {
        &self.share
    }

    pub(super) fn layout(&self) -> Layout {
        self.layout
    }

    /// One step for each entry of `weather`.
    pub(super) fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error> {
        for passage in weather.chunks(self.share.block) {
            self.exchange(self.share.halo(passage.len()))?;
            if let Some(machine) = &mut self.machine {
                machine.advance(passage, recorded)?;
            }
        }
        Ok(())
    }

    /// Gets so many rows around its own from the neighbours, as they are now.
    fn exchange(&mut self, halo: usize) -> Result<(), Error> {
        let Some(machine) = &mut self.machine else { return Ok(()) };
        let (own, first) = (self.share.own(), self.share.held().start);
        let sides = [
            (self.share.north(), own.start..own.start + halo, own.start.saturating_sub(halo)..own.start),
            (self.share.south(), own.end.saturating_sub(halo)..own.end, own.end..own.end + halo),
        ];
        let columns = self.layout.columns;
        let places = |rows: &Range<usize>| {
            let rows = rows.start - first..rows.end - first;
            let planes = self.state_planes;
            rows.flat_map(move |y| (0..planes).map(move |plane| (y, plane)))
        };
        let mut swaps = Vec::with_capacity(2);
        let buffers = self.given.iter_mut().zip(&mut self.taken);
        for ((with, ours, theirs), (give, take)) in sides.iter().zip(buffers) {
            let Some(with) = *with else { continue };
            give.clear();
            places(ours).for_each(|(y, plane)| give.extend_from_slice(machine.world().plane(y, plane)));
            take.resize(theirs.len() * self.state_planes * columns, 0.0);
            swaps.push(Swap { with, give, take });
        }
        if !swaps.is_empty() {
            self.ranks.swap(&mut swaps)?;
        }
        for ((with, _, theirs), take) in sides.iter().zip(&self.taken) {
            if with.is_some() {
                for ((y, plane), cells) in places(theirs).zip(take.chunks_exact(columns)) {
                    machine.world_mut().plane_mut(y, plane).copy_from_slice(cells);
                }
            }
        }
        Ok(())
    }

    /// Column, row of the whole and plane of the first value in its own rows that is no number.
    pub(super) fn first_not_finite(&self) -> Option<[usize; 3]> {
        let first = self.share.held().start;
        let own = self.share.own();
        let world = self.machine.as_ref()?.world();
        let [x, y, plane] =
            world.first_not_finite_in(own.start - first..own.end - first, self.state_planes)?;
        Some([x, y + first, plane])
    }

    pub(super) fn keep(&mut self) -> Result<(), Error> {
        self.machine.as_mut().map_or(Ok(()), Machine::keep)
    }

    pub(super) fn go_back(&mut self) -> Result<(), Error> {
        self.machine.as_mut().map_or(Ok(()), Machine::go_back)
    }

    pub(super) fn clear_means(&mut self) -> Result<(), Error> {
        self.machine.as_mut().map_or(Ok(()), Machine::clear_means)
    }

    /// Its own rows with their sums and means, for [`take`].
    pub(super) fn part(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        let Some(machine) = &self.machine else { return writer.0 };
        let (own, first, columns) = (self.share.own(), self.share.held().start, self.layout.columns);
        let rows = own.start - first..own.end - first;
        for y in rows.clone() {
            (0..self.layout.planes).for_each(|plane| writer.singles(machine.world().plane(y, plane)));
        }
        machine.world().row_sums()[rows.clone()].iter().for_each(|sums| writer.doubles(sums));
        for mean in machine.means() {
            writer.singles(&mean[rows.start * columns..rows.end * columns]);
        }
        writer.0
    }

    /// What of a window lies in its own rows, for [`take_cut`].
    pub(super) fn cut(&self, window: &Window) -> Vec<u8> {
        let mut writer = Writer::default();
        let Some(machine) = &self.machine else { return writer.0 };
        let first = self.share.held().start;
        for y in common(&self.share.own(), &window.rows) {
            for plane in 0..self.layout.planes {
                writer.singles(&machine.world().plane(y - first, plane)[window.columns.clone()]);
            }
        }
        writer.0
    }

    /// Sums of its first row.
    pub(super) fn first_sums(&self) -> crate::sums::RowSums {
        self.machine.as_ref().map(|machine| machine.world().row_sums()[0]).unwrap_or_default()
    }

    /// Lays a patch over the rows that it holds.
    pub(super) fn lay(&mut self, patch: &Patch) {
        let (held, leads) = (self.share.held(), self.ranks.leads());
        let Some(machine) = &mut self.machine else { return };
        let world = machine.world_mut();
        patch.put(|y, plane, x, cells| {
            if held.contains(&y) {
                world.plane_mut(y - held.start, plane)[x..][..cells.len()].copy_from_slice(cells);
            }
        });
        if leads {
            let mut sums = world.row_sums();
            sums[0] = patch.sums;
            world.set_row_sums(&sums);
        }
    }
}

/// The part of a state that a rank begins with: the rows that it holds, and sums and means of its own.
pub(super) fn deal(snapshot: &Snapshot, share: &Share) -> Vec<u8> {
    let mut writer = Writer::default();
    let (own, columns) = (share.own(), snapshot.state.layout.columns);
    for y in share.held() {
        (0..snapshot.state.layout.planes).for_each(|plane| writer.singles(snapshot.state.plane(y, plane)));
    }
    snapshot.row_sums[own.clone()].iter().for_each(|sums| writer.doubles(sums));
    for mean in &snapshot.means {
        writer.singles(&mean[own.start * columns..own.end * columns]);
    }
    writer.0
}

fn read_part(
    reader: &mut Reader<'_>,
    share: &Share,
    layout: Layout,
    means: usize,
) -> Result<Snapshot, Error> {
    let (own, held, columns) = (share.own(), share.held(), layout.columns);
    let mut snapshot = Snapshot::start(Rows::new(layout, held.len()), means);
    for y in 0..held.len() {
        (0..layout.planes).try_for_each(|plane| reader.singles(snapshot.state.plane_mut(y, plane)))?;
    }
    let rows = own.start - held.start..own.end - held.start;
    snapshot.row_sums[rows.clone()].iter_mut().try_for_each(|sums| reader.doubles(sums))?;
    for mean in &mut snapshot.means {
        reader.singles(&mut mean[rows.start * columns..rows.end * columns])?;
    }
    Ok(snapshot)
}

/// Puts a rank's own rows, sums and means into the whole.
pub(super) fn take(whole: &mut Snapshot, share: &Share, part: &[u8]) -> Result<(), Error> {
    let mut reader = Reader(part);
    let (own, layout) = (share.own(), whole.state.layout);
    for y in own.clone() {
        (0..layout.planes).try_for_each(|plane| reader.singles(whole.state.plane_mut(y, plane)))?;
    }
    whole.row_sums[own.clone()].iter_mut().try_for_each(|sums| reader.doubles(sums))?;
    for mean in &mut whole.means {
        reader.singles(&mut mean[own.start * layout.columns..own.end * layout.columns])?;
    }
    Ok(())
}

/// Puts what a rank has of a window into the rows of the window.
pub(super) fn take_cut(rows: &mut Rows, window: &Window, share: &Share, part: &[u8]) -> Result<(), Error> {
    let mut reader = Reader(part);
    for y in common(&share.own(), &window.rows) {
        let into = y - window.rows.start;
        (0..rows.layout.planes).try_for_each(|plane| reader.singles(rows.plane_mut(into, plane)))?;
    }
    Ok(())
}

fn common(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    a.start.max(b.start)..a.end.min(b.end)
}
