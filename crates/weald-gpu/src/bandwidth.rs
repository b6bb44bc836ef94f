//! How fast a device copies its own memory: the bound of every pass that computes little.

use web_time::Instant;

use weald::Error;
use wgpu::{
    BufferBindingType, BufferUsages, CommandEncoder, CommandEncoderDescriptor, ComputePassDescriptor,
};

use crate::compiled::{Pipeline, entry};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Most bytes of a copy: far beyond the caches of any card.
const MAX_BYTES: u64 = 1 << 30;

/// Time that a measurement should take.
const SECONDS: f64 = 0.05;

/// Measurements, of which the best counts: others' work only ever makes one slower.
const RUNS: usize = 5;

/// Bytes that an invocation copies at once.
const BYTES_AT_ONCE: u64 = 16;

/// Invocations of a workgroup, as in the shader.
const GROUP: u64 = 256;

/// Most workgroups of a dispatch; what is left is copied in strides.
const GROUPS: u64 = 65_535;

impl Gpu {
    /// Bytes per second that the device reads and writes while it copies a buffer over another, by a compute pass or by
    /// a command, whichever is faster: an H100 copies by commands at less than a third of what its passes move.
    ///
    /// # Errors
    /// [`Error::Device`] where there is no memory for two buffers, or the device is lost.
    pub fn copy_bandwidth(&self) -> Result<f64, Error> {
        let free = self.memory.budget() - self.allocated();
        let bytes = MAX_BYTES.min(free / 4).min(self.largest_binding()) & !255;
        let usage = BufferUsages::COPY_SRC | BufferUsages::COPY_DST | BufferUsages::STORAGE;
        let store = || Store::new(self, "a buffer to measure the bandwidth", bytes, usage);
        let [from, into] = [store()?, store()?];
        let by_command = self.copies_a_second(|encoder| {
            encoder.copy_buffer_to_buffer(&from.buffer, 0, &into.buffer, 0, bytes);
        })?;
        Ok(2.0 * bytes as f64 * by_command.max(self.copies_by_pass([&from, &into])?))
    }

    /// How often a second a compute pass copies one buffer over another.
    fn copies_by_pass(&self, [from, into]: [&Store; 2]) -> Result<f64, Error> {
        let storage = |read_only| BufferBindingType::Storage { read_only };
        let entries = [entry(0, storage(true), false), entry(1, storage(false), false)];
        let shader = include_str!("copies.wgsl");
        let compile = || Ok(Pipeline::compile(self, "copies", shader, &entries));
        let pipeline = self.context.attempt("compiling a copy", compile)?;
        let stores = [(0, from), (1, into)];
        let bindings = stores.map(|(binding, store)| (binding, store.buffer.as_entire_binding()));
        let bound = pipeline.bind(self, bindings.into())?;
        let groups = from.buffer.size().div_ceil(BYTES_AT_ONCE * GROUP).min(GROUPS) as u32;
        self.copies_a_second(|encoder| {
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline.pipeline);
            pass.set_bind_group(0, &bound, &[]);
            pass.dispatch_workgroups(groups, 1, 1);
        })
    }

    /// How often a second this is done.
    fn copies_a_second(&self, copy: impl Fn(&mut CommandEncoder)) -> Result<f64, Error> {
        let seconds_of = |copies: u32| {
            let begun = Instant::now();
            let submission = self.context.attempt("copying to measure the bandwidth", || {
                let mut encoder =
                    self.context.device.create_command_encoder(&CommandEncoderDescriptor::default());
                (0..copies).for_each(|_| copy(&mut encoder));
                Ok(self.context.submit([encoder.finish()]))
            })?;
            self.context.wait(Some(submission))?;
            Ok::<_, Error>(begun.elapsed().as_secs_f64())
        };
        // The first copy sets the memory to zero and tells how many make a measurement.
        seconds_of(1)?;
        let copies = (SECONDS / seconds_of(1)?).clamp(1.0, 1000.0) as u32;
        let mut best = f64::INFINITY;
        for _ in 0..RUNS {
            best = best.min(seconds_of(copies)?);
        }
        Ok(f64::from(copies) / best)
    }
}
