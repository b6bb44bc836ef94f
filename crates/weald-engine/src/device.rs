//! What the library asks of a compute device. The crate `weald-gpu` answers; here is no GPU interface.

use std::fmt::Debug;

use super::program::Program;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
pub use weald_core::plane::Window;

/// A device that runs [`Program`]s.
pub trait Device: Debug + Send + Sync {
    /// The adapter and its driver, for the report.
    fn adapter(&self) -> String;

    /// Bytes that the buffers of programs may take together.
    fn memory(&self) -> u64;

    /// Most bytes of one buffer.
    fn largest_buffer(&self) -> u64;

    /// Compiles a program and allocates its buffers for grids of up to `size`, all zero.
    ///
    /// # Errors
    /// [`Error::Device`] where the device refuses: out of memory, lost.
    fn load(&self, program: &Program, size: Size) -> Result<Box<dyn Loaded>, Error>;

    /// Receives where the ground of the next simulation lies, for devices that show it as it runs.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    fn shows(&self, ground: &ShownGround<'_>) -> Result<(), Error> {
        let _ = ground;
        Ok(())
    }
}

/// How the grid of a simulation lies in its landscape.
#[derive(Clone, Copy, Debug)]
pub struct ShownGround<'a> {
    /// Ground of the landscape at the start, in metres.
    pub start: &'a Field,
    /// Water on it in metres, where some stands.
    pub water: Option<&'a Field>,
    /// Columns and rows of the simulation.
    pub size: Size,
    /// Column and row of the landscape at which the simulation begins; -1 where it has a ring of cells around it.
    pub first: [i32; 2],
    /// Metres that are 1 in the simulation.
    pub unit: f32,
    /// Elevation in metres that is 0 in the simulation.
    pub lowest: f32,
}

/// A program on a device, with its state. All errors are [`Error::Device`].
pub trait Loaded: Send {
    /// Works on a grid of this size from now on, no larger than the one that was loaded, and counts sums over
    /// the cells of `own` alone. What buffers hold is lost, sums start at zero.
    fn begin(&mut self, size: Size, own: &Window) -> Result<(), Error>;

    /// Overwrites a buffer: its lanes cell by cell, row-major, or plane by plane where it is layered; of a
    /// table its lanes element by element. Whole numbers come as the bits of `f32`.
    fn write(&mut self, buffer: usize, values: &[f32]) -> Result<(), Error>;

    /// A copy of a buffer, after all steps given so far.
    fn read(&mut self, buffer: usize) -> Result<Vec<f32>, Error>;

    /// One step for each entry of `weather`, which holds the words of its struct.
    fn run(&mut self, weather: &[Vec<u32>], recorded: bool) -> Result<(), Error>;

    /// Sums since [`Loaded::begin`] or the last [`Loaded::clear_sums`], in the order of the tallies.
    fn sums(&mut self) -> Result<Vec<f64>, Error>;

    /// Sets the sums to zero.
    fn clear_sums(&mut self) -> Result<(), Error>;

    /// Index of the first value of a buffer that is a NaN or an infinity.
    fn first_not_finite(&mut self, buffer: usize) -> Result<Option<usize>, Error>;

    /// Keeps a copy of all state, means and sums on the device.
    fn keep(&mut self) -> Result<(), Error>;

    /// Goes back to the copy.
    fn go_back(&mut self) -> Result<(), Error>;

    /// Overwrites a rectangle of a buffer of cells, in the order of [`Loaded::write`] over the rectangle alone.
    fn write_part(&mut self, buffer: usize, window: &Window, values: &[f32]) -> Result<(), Error>;

    /// A copy of a rectangle of a buffer of cells, after all steps given so far.
    fn read_part(&mut self, buffer: usize, window: &Window) -> Result<Vec<f32>, Error>;

    /// Keeps a copy of state, constant planes, means and sums on the device under a number.
    fn keep_as(&mut self, number: u64) -> Result<(), Error>;

    /// Goes back to the copy of that number.
    fn return_to(&mut self, number: u64) -> Result<(), Error>;

    /// Forgets the copy of that number.
    fn release(&mut self, number: u64);

    /// Sets all means to zero.
    fn clear_means(&mut self) -> Result<(), Error>;

    /// Replaces the constants of the method by other numbers of the same struct.
    fn set_constants(&mut self, words: &[u32]) -> Result<(), Error>;

    /// Shows ground and water as they are now to those who look on.
    fn show(&mut self) -> Result<(), Error>;
}
