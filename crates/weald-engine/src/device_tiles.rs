//! Tiles on a device whose memory does not hold the whole.

use std::sync::Arc;

use super::device::{Device, Loaded, Window};
use super::device_machine::{download, sums, upload};
use super::machine::Snapshot;
use super::program::Program;
use super::tiles::{Visit, Worker};
use super::uniform::Uniform;
use crate::stencil::chain::Process;
use weald_core::error::Error;
use weald_core::grid::Size;

/// A program with memory for one tile, which all tiles use in turn.
pub(crate) struct DeviceTiles {
    program: Program,
    loaded: Box<dyn Loaded>,
}

impl DeviceTiles {
    pub(crate) fn new(program: Program, device: &dyn Device, tile: Size) -> Result<Self, Error> {
        let loaded = device.load(&program, tile)?;
        Ok(Self { program, loaded })
    }
}

impl<P: Process> Worker<P> for DeviceTiles {
    fn run(
        &mut self,
        mut tile: Snapshot,
        own: &Window,
        steps: &Visit<'_, P::Weather>,
    ) -> Result<Snapshot, Error> {
        let loaded = &mut *self.loaded;
        loaded.begin(tile.size(), own)?;
        upload(&self.program, loaded, &tile)?;
        let words: Vec<_> = steps.weather.iter().map(Uniform::words).collect();
        loaded.run(&words, steps.recorded)?;
        download(&self.program, loaded, &mut tile)?;
        tile.row_sums[own.rows.start] = sums(loaded)?;
        Ok(tile)
    }

    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error> {
        let program = process.program();
        if !self.program.differs_in_numbers_alone(&program) {
            let message =
                format!("`{}` cannot change its passes while it runs in tiles on a device", program.name);
            return Err(Error::Run(message));
        }
        self.loaded.set_constants(&program.constants.words)?;
        self.program = program;
        Ok(())
    }
}
