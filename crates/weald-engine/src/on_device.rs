//! Generators on a device: one program, tables from the host, and the landscape in bands of rows where the
//! device's memory does not hold it whole.

use crate::device::{Device, Loaded, Window};
use crate::device_machine::most_cells;
use crate::program::Program;
use weald_core::error::Error;
use weald_core::grid::Size;

/// A generator's program and what it reads.
pub struct OnDevice {
    /// The program.
    pub program: Program,
    /// Names and contents of the tables.
    pub tables: Vec<(&'static str, Vec<u32>)>,
    /// The grid that it works on.
    pub size: Size,
    /// Whether rows can be made band by band.
    pub in_bands: bool,
    /// Weather of each step for the band that begins with a row.
    pub steps: Box<dyn Fn(u32) -> Vec<Vec<u32>>>,
    /// The buffer that holds the result after the last step.
    pub result: &'static str,
}

impl std::fmt::Debug for OnDevice {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("OnDevice").field("program", &self.program.name).finish_non_exhaustive()
    }
}

impl OnDevice {
    /// The result of all cells of the grid, row-major, on a device that it is not too large for.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn run(&self, device: &dyn Device) -> Result<Vec<f32>, Error> {
        let Size { columns, rows } = self.size;
        let most = self.rows_at_once(device);
        let mut loaded = device.load(&self.program, Size { columns, rows: most })?;
        let mut result = Vec::with_capacity(self.size.cells());
        for first in (0..rows).step_by(most) {
            let band = Size { columns, rows: most.min(rows - first) };
            loaded.begin(band, &Window::whole(band))?;
            self.write_tables(&mut *loaded)?;
            loaded.run(&(self.steps)(first as u32), false)?;
            result.extend(loaded.read(self.program.buffer(self.result))?);
        }
        Ok(result)
    }

    /// Why the device's memory is too small, where it is.
    pub fn too_large_for(&self, device: &dyn Device) -> Option<String> {
        let most = self.rows_at_once(device);
        let fits = most == self.size.rows || self.in_bands && most > 0;
        (!fits).then(|| {
            let Size { columns, rows } = self.size;
            let (name, memory) = (self.program.name, device.memory());
            format!("{columns} × {rows} cells of `{name}` do not fit into {memory} bytes of its memory")
        })
    }

    /// Rows that the device's memory holds.
    fn rows_at_once(&self, device: &dyn Device) -> usize {
        let most = most_cells(&self.program, device) / self.size.columns as u64;
        most.min(self.size.rows as u64) as usize
    }

    fn write_tables(&self, loaded: &mut dyn Loaded) -> Result<(), Error> {
        for (name, words) in &self.tables {
            let bits: Vec<_> = words.iter().copied().map(f32::from_bits).collect();
            loaded.write(self.program.buffer(name), &bits)?;
        }
        Ok(())
    }
}
