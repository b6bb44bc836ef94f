//! A device that counts the bytes that move between it and the host.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use weald::Error;
use weald::engine::device::{Device, Loaded, Window};
use weald::engine::program::Program;
use weald::grid::Size;
use weald_gpu::Gpu;

/// Bytes that have moved.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moved(Arc<AtomicU64>);

impl Moved {
    pub(crate) fn bytes(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(crate) fn reset(&self) {
        self.0.store(0, Ordering::Relaxed);
    }

    fn add(&self, numbers: usize) {
        self.0.fetch_add(4 * numbers as u64, Ordering::Relaxed);
    }
}

#[derive(Debug)]
pub(crate) struct Counting {
    gpu: Gpu,
    moved: Moved,
}

impl Counting {
    pub(crate) fn new(gpu: Gpu) -> Self {
        Self { gpu, moved: Moved::default() }
    }

    pub(crate) fn moved(&self) -> Moved {
        self.moved.clone()
    }
}

impl Device for Counting {
    fn adapter(&self) -> String {
        self.gpu.adapter()
    }

    fn memory(&self) -> u64 {
        self.gpu.memory()
    }

    fn largest_buffer(&self) -> u64 {
        self.gpu.largest_buffer()
    }

    fn load(&self, program: &Program, size: Size) -> Result<Box<dyn Loaded>, Error> {
        let loaded = self.gpu.load(program, size)?;
        Ok(Box::new(Counted { loaded, moved: self.moved.clone() }))
    }
}

struct Counted {
    loaded: Box<dyn Loaded>,
    moved: Moved,
}

impl Loaded for Counted {
    fn begin(&mut self, size: Size, own: &Window) -> Result<(), Error> {
        self.loaded.begin(size, own)
    }

    fn write(&mut self, buffer: usize, values: &[f32]) -> Result<(), Error> {
        self.moved.add(values.len());
        self.loaded.write(buffer, values)
    }

    fn read(&mut self, buffer: usize) -> Result<Vec<f32>, Error> {
        let values = self.loaded.read(buffer)?;
        self.moved.add(values.len());
        Ok(values)
    }

    fn run(&mut self, weather: &[Vec<u32>], recorded: bool) -> Result<(), Error> {
        self.loaded.run(weather, recorded)
    }

    fn sums(&mut self) -> Result<Vec<f64>, Error> {
        self.loaded.sums()
    }

    fn clear_sums(&mut self) -> Result<(), Error> {
        self.loaded.clear_sums()
    }

    fn first_not_finite(&mut self, buffer: usize) -> Result<Option<usize>, Error> {
        self.loaded.first_not_finite(buffer)
    }

    fn keep(&mut self) -> Result<(), Error> {
        self.loaded.keep()
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.loaded.go_back()
    }

    fn write_part(&mut self, buffer: usize, window: &Window, values: &[f32]) -> Result<(), Error> {
        self.moved.add(values.len());
        self.loaded.write_part(buffer, window, values)
    }

    fn read_part(&mut self, buffer: usize, window: &Window) -> Result<Vec<f32>, Error> {
        let values = self.loaded.read_part(buffer, window)?;
        self.moved.add(values.len());
        Ok(values)
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.loaded.keep_as(number)
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        self.loaded.return_to(number)
    }

    fn release(&mut self, number: u64) {
        self.loaded.release(number);
    }

    fn clear_means(&mut self) -> Result<(), Error> {
        self.loaded.clear_means()
    }

    fn set_constants(&mut self, words: &[u32]) -> Result<(), Error> {
        self.moved.add(words.len());
        self.loaded.set_constants(words)
    }

    fn show(&mut self) -> Result<(), Error> {
        self.loaded.show()
    }
}
