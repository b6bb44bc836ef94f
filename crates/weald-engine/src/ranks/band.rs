//! The rows of one rank: advanced as a grid of their own, between exchanges of those around them.

use std::ops::Range;
use std::sync::Arc;

use web_time::Instant;

use super::border::Border;
use super::bytes::{Reader, Writer};
use super::messages::Ranks;
use super::overlap::{Overlap, Trial};
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
    border: Border,
    trial: Trial,
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
        let mut machine = (!share.own().is_empty()).then(|| {
            let process = Arc::new(process.sized(Size { columns: layout.columns, rows: share.held().len() }));
            CpuMachine::new(&process, means, &start, None)
        });
        if let (Overlap::Always, Some(machine)) = (ranks.overlap(), &mut machine) {
            machine.world_mut().cut_with_edges(share.edges(), share.block);
        }
        let (state_planes, trial) = (process.state_planes(), Trial::of(ranks.overlap()));
        let border = Border::new(share.clone(), (layout.columns, state_planes));
        Ok(Self { ranks: Arc::clone(ranks), share, layout, state_planes, machine, border, trial })
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
            let begun = Instant::now();
            let waited = self.passage(passage, recorded)?;
            if self.trial.is_running() && passage.len() == self.share.block {
                self.look_at(waited, begun.elapsed().as_secs_f64());
            }
        }
        Ok(())
    }

    /// Steps between two exchanges; gives the seconds for which nothing was done but to wait for messages.
    fn passage(&mut self, weather: &[P::Weather], recorded: bool) -> Result<f64, Error> {
        let Some(machine) = &mut self.machine else { return Ok(0.0) };
        let halo = self.share.halo(weather.len());
        self.border.give(halo, |y, plane| machine.world().plane(y, plane));
        if machine.world().has_edges() {
            if cfg!(debug_assertions) {
                // What reads rows before they have come gets no number, and is seen by that.
                let world = machine.world_mut();
                self.border.spoil(|y, plane| world.plane_mut(y, plane).fill(f32::NAN));
            }
            let (border, ranks) = (&mut self.border, &self.ranks);
            machine.advance_inside_first(weather, recorded, |edges| {
                border.swap(halo, |swaps| ranks.swap_aside(swaps))?;
                border.take(halo, |y, plane, cells| edges.plane_mut(y, plane).copy_from_slice(cells));
                Ok(())
            })?;
            return Ok(0.0);
        }
        let begun = Instant::now();
        self.border.swap(halo, |swaps| self.ranks.swap(swaps))?;
        let waited = begun.elapsed().as_secs_f64();
        let world = machine.world_mut();
        self.border.take(halo, |y, plane, cells| world.plane_mut(y, plane).copy_from_slice(cells));
        machine.advance(weather, recorded)?;
        Ok(waited)
    }

    /// Takes the order of inside and messages that is faster.
    fn look_at(&mut self, waited: f64, took: f64) {
        let (edges, block) = (self.share.edges(), self.share.block);
        let Some(machine) = &mut self.machine else { return };
        let Some(cost) = machine.world().cost_of_edges(edges, block).filter(|_| edges != [0; 2]) else {
            return;
        };
        match self.trial.passed(waited, took, cost) {
            Some(true) => machine.world_mut().cut_with_edges(edges, block),
            Some(false) => machine.world_mut().cut_without_edges(),
            None => {}
        }
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
