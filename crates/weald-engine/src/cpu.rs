//! A simulation on the CPU: the world in bands, and the means over its recorded steps.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::bands::{BandedGrid, Edges};
use super::device::Window;
use super::machine::{Machine, Means, Snapshot};
use super::patch::{Patch, Patched};
use crate::stencil::chain::Process;
use weald_core::error::Error;

/// The state of a simulation on the CPU.
pub(crate) struct CpuMachine<P: Process> {
    process: Arc<P>,
    world: BandedGrid<P>,
    parts: Means<'static>,
    means: Vec<Vec<f32>>,
    kept: Snapshot,
    /// Copies by their numbers.
    copies: BTreeMap<u64, Snapshot>,
}

impl<P: Process> CpuMachine<P> {
    /// In one band a thread, or in so many bands.
    pub(crate) fn new(
        process: &Arc<P>,
        parts: Means<'static>,
        start: &Snapshot,
        bands: Option<usize>,
    ) -> Self {
        let columns = 0..start.state.layout.columns;
        let mut world = BandedGrid::new(process, &start.state, bands, columns);
        world.set_row_sums(&start.row_sums);
        let (process, copies) = (Arc::clone(process), BTreeMap::new());
        Self { process, world, parts, means: start.means.clone(), kept: start.clone(), copies }
    }

    /// Rows of sums, and means, for an engine that puts them together.
    pub(crate) fn into_parts(self) -> Snapshot {
        Snapshot { state: self.world.state(), row_sums: self.world.row_sums(), means: self.means }
    }

    /// Its rows.
    pub(crate) fn world(&self) -> &BandedGrid<P> {
        &self.world
    }

    /// The same, to be changed.
    pub(crate) fn world_mut(&mut self) -> &mut BandedGrid<P> {
        &mut self.world
    }

    /// One time block, of which the inner bands are computed while `arrive` waits for the rows beyond the edges.
    pub(crate) fn advance_inside_first(
        &mut self,
        weather: &[P::Weather],
        recorded: bool,
        arrive: impl FnOnce(&mut Edges<'_, P>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let parts = if recorded { self.parts } else { &[] };
        self.world.advance_inside_first(weather, (parts, &mut self.means), arrive)
    }

    /// Sums over the recorded steps, row-major.
    pub(crate) fn means(&self) -> &[Vec<f32>] {
        &self.means
    }

    /// The same, counting the sums of these columns alone.
    pub(crate) fn count_columns(mut self, columns: std::ops::Range<usize>) -> Self {
        self.world.count_columns(columns);
        self
    }
}

impl<P: Process> Patched for CpuMachine<P> {
    fn patch(&mut self, window: &Window) -> Result<Patch, Error> {
        let sums = self.world.row_sums()[0];
        Ok(Patch::cut(self.world.planes(), window, sums, |y, plane| self.world.plane(y, plane)))
    }

    fn lay(&mut self, patch: &Patch) -> Result<(), Error> {
        patch.put(|y, plane, x, cells| {
            self.world.plane_mut(y, plane)[x..][..cells.len()].copy_from_slice(cells);
        });
        let mut sums = self.world.row_sums();
        sums[0] = patch.sums;
        self.world.set_row_sums(&sums);
        Ok(())
    }
}

impl<P: Process> Machine<P> for CpuMachine<P> {
    fn block(&self) -> usize {
        self.world.block()
    }

    fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error> {
        let parts = if recorded { self.parts } else { &[] };
        self.world.advance(weather, parts, &mut self.means);
        Ok(())
    }

    fn first_not_finite(&mut self) -> Result<Option<[usize; 3]>, Error> {
        Ok(self.world.first_not_finite(self.process.state_planes()))
    }

    fn keep(&mut self) -> Result<(), Error> {
        // Constant planes do not change but by a person, after which all is kept anew.
        self.world.copy_state(&mut self.kept.state, self.process.state_planes());
        self.kept.row_sums = self.world.row_sums();
        self.kept.means.clone_from(&self.means);
        Ok(())
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.world.set_state(&self.kept.state, self.process.state_planes());
        self.world.set_row_sums(&self.kept.row_sums);
        self.means.clone_from(&self.kept.means);
        Ok(())
    }

    fn snapshot(&mut self) -> Result<Snapshot, Error> {
        Ok(Snapshot { state: self.world.state(), row_sums: self.world.row_sums(), means: self.means.clone() })
    }

    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.world.set_state(&snapshot.state, snapshot.state.layout.planes);
        self.world.set_row_sums(&snapshot.row_sums);
        self.means.clone_from(&snapshot.means);
        self.keep()
    }

    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error> {
        let sums = self.world.row_sums();
        let (bands, columns) = (self.world.wanted(), self.world.columns());
        self.world = BandedGrid::new(process, &self.world.state(), bands, columns);
        self.world.set_row_sums(&sums);
        self.process = Arc::clone(process);
        Ok(())
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        let copy = self.snapshot()?;
        self.copies.insert(number, copy);
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        let copy = self.copies.get(&number).ok_or_else(|| super::machine::never_kept(number))?;
        self.world.set_state(&copy.state, copy.state.layout.planes);
        self.world.set_row_sums(&copy.row_sums);
        self.means.clone_from(&copy.means);
        Ok(())
    }

    fn release(&mut self, number: u64) {
        self.copies.remove(&number);
    }

    fn bytes_of_copy(&self) -> u64 {
        self.kept.bytes() as u64
    }

    fn clear_means(&mut self) -> Result<(), Error> {
        self.means.iter_mut().for_each(|mean| mean.fill(0.0));
        Ok(())
    }
}
