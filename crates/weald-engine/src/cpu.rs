//! A simulation on the CPU: the world in bands, and the means over its recorded steps.

use super::bands::BandedGrid;
use super::machine::{Machine, Means, Snapshot};
use crate::stencil::chain::Process;
use weald_core::error::Error;

/// The state of a simulation on the CPU.
pub(crate) struct CpuMachine<'a, P: Process> {
    process: &'a P,
    world: BandedGrid<'a, P>,
    parts: Means<'a>,
    means: Vec<Vec<f32>>,
    kept: Snapshot,
}

impl<'a, P: Process> CpuMachine<'a, P> {
    /// In one band a thread, or in bands that own their memory.
    pub(crate) fn new(process: &'a P, parts: Means<'a>, start: &Snapshot, bands: Option<usize>) -> Self {
        let columns = 0..start.state.layout.columns;
        let mut world = BandedGrid::new(process, start.state.clone(), bands, columns);
        world.set_row_sums(&start.row_sums);
        Self { process, world, parts, means: start.means.clone(), kept: start.clone() }
    }

    /// Rows of sums, and means, for an engine that puts them together.
    pub(crate) fn into_parts(self) -> Snapshot {
        Snapshot { state: self.world.state(), row_sums: self.world.row_sums(), means: self.means }
    }

    /// The same, counting the sums of these columns alone.
    pub(crate) fn count_columns(mut self, columns: std::ops::Range<usize>) -> Self {
        self.world.count_columns(columns);
        self
    }

    fn add_to_means(&mut self) {
        for (mean, parts) in self.means.iter_mut().zip(self.parts) {
            for part in *parts {
                self.world.add_plane_to(part.plane, part.from, part.factor, mean);
            }
        }
    }
}

impl<P: Process> Machine<P::Weather> for CpuMachine<'_, P> {
    fn block(&self) -> usize {
        self.world.block()
    }

    fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error> {
        if !recorded {
            self.world.advance(weather);
            return Ok(());
        }
        for weather in weather {
            self.world.advance(std::slice::from_ref(weather));
            self.add_to_means();
        }
        Ok(())
    }

    fn first_not_finite(&mut self) -> Result<Option<[usize; 3]>, Error> {
        Ok(self.world.first_not_finite(self.process.state_planes()))
    }

    fn keep(&mut self) -> Result<(), Error> {
        self.world.copy_state(&mut self.kept.state);
        self.kept.row_sums = self.world.row_sums();
        self.kept.means.clone_from(&self.means);
        Ok(())
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.world.set_state(&self.kept.state);
        self.world.set_row_sums(&self.kept.row_sums);
        self.means.clone_from(&self.kept.means);
        Ok(())
    }

    fn snapshot(&mut self) -> Result<Snapshot, Error> {
        Ok(Snapshot { state: self.world.state(), row_sums: self.world.row_sums(), means: self.means.clone() })
    }

    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.world.set_state(&snapshot.state);
        self.world.set_row_sums(&snapshot.row_sums);
        self.means.clone_from(&snapshot.means);
        self.keep()
    }
}
