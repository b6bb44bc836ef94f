//! Passes bound to the buffers that they read and write, for even and for odd steps, and their dispatch.

use weald::Error;
use weald::engine::program::{Pass, Program};
use wgpu::{BindGroup, CommandEncoder, ComputePassDescriptor};

use super::buffers::Buffers;
use super::extents::Extents;
use super::parts::Part;
use super::uniforms::Uniforms;
use crate::compiled::{Bindings, Pipeline};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Bytes per cell that even a pass which moves nothing is taken to move: it computes.
const MIN_BYTES_PER_CELL: u64 = 4;

/// A pass that can be dispatched.
#[derive(Debug)]
pub(crate) struct BoundPass {
    pub(crate) pipeline: Pipeline,
    /// For even and for odd steps.
    pub(crate) bound: [BindGroup; 2],
    pub(crate) bytes_per_cell: u64,
    /// Whether it runs in recorded steps alone.
    pub(crate) recorded: bool,
}

/// Where a program's passes find what they work on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassResources<'a> {
    pub(crate) program: &'a Program,
    pub(crate) uniforms: &'a Uniforms,
    pub(crate) buffers: &'a Buffers,
    pub(crate) sums: &'a Store,
}

impl PassResources<'_> {
    /// All passes of the program.
    pub(crate) fn ready(self, gpu: &Gpu) -> Result<Vec<BoundPass>, Error> {
        self.program.passes.iter().map(|pass| self.ready_pass(gpu, pass)).collect()
    }

    fn ready_pass(self, gpu: &Gpu, pass: &Pass) -> Result<BoundPass, Error> {
        let pipeline = Pipeline::of(gpu, self.program, pass)?;
        let bind = |odd| pipeline.bind(gpu, self.bindings(pass, odd));
        let bound = [bind(false)?, bind(true)?];
        let bound_to = self.program.bound(pass).into_iter().map(|(at, _)| &self.program.buffers[at]);
        let grown = bound_to.map(|buffer| 4 * (buffer.length(1) - buffer.length(0)) as u64);
        let bytes_per_cell = grown.sum::<u64>().max(MIN_BYTES_PER_CELL);
        Ok(BoundPass { pipeline, bound, bytes_per_cell, recorded: pass.recorded })
    }

    /// Resources in the order that [`Program::module`] declares.
    fn bindings(&self, pass: &Pass, odd: bool) -> Bindings<'_> {
        let mut bindings = vec![(0, self.uniforms.grid.binding())];
        if !self.program.constants.name.is_empty() {
            bindings.push((1, self.uniforms.constants.binding()));
        }
        if !self.program.weather.name.is_empty() {
            bindings.push((2, self.uniforms.weather.binding()));
        }
        let bound = self.program.bound(pass);
        let stores = bound.iter().map(|&(buffer, _)| self.buffers.playing(buffer, odd));
        let stores = stores.chain(pass.tallies.then_some(self.sums));
        bindings.extend((3..).zip(stores.map(|store| store.buffer.as_entire_binding())));
        bindings
    }
}

/// What one submission dispatches with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Submission<'a> {
    pub(crate) passes: &'a [BoundPass],
    pub(crate) uniforms: &'a Uniforms,
    pub(crate) extents: Extents,
    /// Whether the first step of the run is an odd one.
    pub(crate) odd: bool,
    pub(crate) sees_weather: bool,
}

impl Submission<'_> {
    /// Dispatches parts, the weather of whose first step lies in the first slot.
    pub(crate) fn encode(self, encoder: &mut CommandEncoder, parts: &[Part]) {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        let first_step = parts.first().map_or(0, |part| part.step);
        for part in parts {
            let ready = &self.passes[part.pass];
            let odd = self.odd ^ (part.step % 2 == 1);
            let offsets =
                [self.uniforms.grid.offset(part.first), self.uniforms.weather.offset(part.step - first_step)];
            pass.set_pipeline(&ready.pipeline.pipeline);
            pass.set_bind_group(
                0,
                &ready.bound[usize::from(odd)],
                &offsets[..=usize::from(self.sees_weather)],
            );
            let [across, rows] = [self.extents.across, self.extents.rows(*part)].map(|groups| groups as u32);
            pass.dispatch_workgroups(across, rows, 1);
        }
    }
}
