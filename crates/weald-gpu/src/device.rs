//! The device that the library knows.

use weald::Error;
use weald::engine::device::{Device, Loaded, ShownGround};
use weald::engine::program::Program;
use weald::grid::Size;

use crate::gpu::Gpu;
use crate::program::Running;

impl Device for Gpu {
    fn adapter(&self) -> String {
        self.context.adapter.clone()
    }

    fn memory(&self) -> u64 {
        self.memory.budget()
    }

    fn largest_buffer(&self) -> u64 {
        self.largest_binding()
    }

    fn load(&self, program: &Program, size: Size) -> Result<Box<dyn Loaded>, Error> {
        Ok(Box::new(Running::new(self.clone(), program, size)?))
    }

    fn shows(&self, ground: &ShownGround<'_>) -> Result<(), Error> {
        self.shows.as_ref().map_or(Ok(()), |shows| shows.begin(self, ground))
    }
}
