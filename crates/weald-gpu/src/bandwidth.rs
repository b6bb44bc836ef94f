//! How fast a device copies its own memory: the bound of every pass that computes little.

use web_time::Instant;

use weald::Error;
use wgpu::{BufferUsages, CommandEncoderDescriptor};

use crate::gpu::Gpu;
use crate::memory::Store;

/// Most bytes of a copy: far beyond the caches of any card.
const MAX_BYTES: u64 = 1 << 30;

/// Time that a measurement should take.
const SECONDS: f64 = 0.05;

/// Measurements, of which the best counts: others' work only ever makes one slower.
const RUNS: usize = 5;

impl Gpu {
    /// Bytes per second that the device reads and writes while it copies a buffer over another.
    ///
    /// # Errors
    /// [`Error::Device`] where there is no memory for two buffers, or the device is lost.
    pub fn copy_bandwidth(&self) -> Result<f64, Error> {
        let free = self.memory.budget() - self.allocated();
        let bytes = MAX_BYTES.min(free / 4).min(self.largest_binding()) & !255;
        let usage = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let store = || Store::new(self, "a buffer to measure the bandwidth", bytes, usage);
        let stores = [store()?, store()?];
        // The first copy sets the memory to zero and tells how many make a measurement.
        self.copy_seconds(&stores, 1)?;
        let copies = (SECONDS / self.copy_seconds(&stores, 1)?).clamp(1.0, 1000.0) as u32;
        let mut best = f64::INFINITY;
        for _ in 0..RUNS {
            best = best.min(self.copy_seconds(&stores, copies)?);
        }
        Ok(2.0 * bytes as f64 * f64::from(copies) / best)
    }

    fn copy_seconds(&self, [from, into]: &[Store; 2], copies: u32) -> Result<f64, Error> {
        let begun = Instant::now();
        let submission = self.context.attempt("copying to measure the bandwidth", || {
            let mut encoder =
                self.context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            for _ in 0..copies {
                encoder.copy_buffer_to_buffer(&from.buffer, 0, &into.buffer, 0, from.buffer.size());
            }
            Ok(self.context.submit([encoder.finish()]))
        })?;
        self.context.wait(Some(submission))?;
        Ok(begun.elapsed().as_secs_f64())
    }
}
