//! The watch for values that are no longer numbers.

use weald::Error;
use wgpu::{BindGroup, Buffer, BufferBindingType, BufferUsages, ComputePassDescriptor};

use crate::compiled::{Pipeline, entry};
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::{Load, Pace, WorkKind};
use crate::slots::Slots;
use crate::transfer::{self, Transfer};

/// Invocations of a workgroup.
const GROUP: u32 = 256;

/// Most workgroups of a dispatch: enough for a large card, which then goes on in strides.
const GROUPS: u32 = 4096;

/// Nothing was found.
const NOT_FOUND: u32 = u32::MAX;

/// Looks through buffers for a NaN or an infinity.
#[derive(Debug)]
pub(crate) struct Watch {
    pipeline: Pipeline,
    range: Slots,
    /// Index of the first value found.
    found: Store,
}

impl Watch {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let entries = [
            entry(0, BufferBindingType::Uniform, false),
            entry(1, BufferBindingType::Storage { read_only: true }, false),
            entry(2, BufferBindingType::Storage { read_only: false }, false),
        ];
        let shader = include_str!("watch.wgsl");
        let pipeline = gpu
            .context
            .attempt("the watch for NaN", || Ok(Pipeline::compile(gpu, "watch", shader, &entries)))?;
        let range = Slots::new(gpu, "the watch's uniform", 3, 1)?;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        Ok(Self { pipeline, range, found: Store::new(gpu, "the watch's result", 4, usage)? })
    }

    /// Index of the first of the first `count` values that is no number.
    pub(crate) fn first(
        &self,
        gpu: &Gpu,
        pace: &mut Pace,
        transfer: &Transfer,
        (buffer, count): (&Buffer, u64),
    ) -> Result<Option<usize>, Error> {
        pace.drain(gpu)?;
        transfer::write(gpu, &self.found.buffer, bytemuck::bytes_of(&NOT_FOUND))?;
        let bound = self.pipeline.bind(
            gpu,
            vec![
                (0, self.range.binding()),
                (1, buffer.as_entire_binding()),
                (2, self.found.buffer.as_entire_binding()),
            ],
        )?;
        let mut first = 0;
        while first < count {
            let end = (first + (pace.allowance(WorkKind::Looks) / 4).max(1)).min(count);
            self.look(gpu, pace, &bound, [first as u32, end as u32])?;
            first = end;
        }
        let found = transfer.read(gpu, pace, &self.found.buffer, 4)?[0].to_bits();
        Ok((found != NOT_FOUND).then_some(found as usize))
    }

    fn look(
        &self,
        gpu: &Gpu,
        pace: &mut Pace,
        bound: &BindGroup,
        [first, end]: [u32; 2],
    ) -> Result<(), Error> {
        let groups = (end - first).div_ceil(GROUP).min(GROUPS);
        let words = [first, end, groups * GROUP];
        let packed = self.range.packed(std::iter::once(words.as_slice()))?;
        let staged = gpu.memory.hold(packed.len() as u64, "staging")?;
        let load = Load { sort: WorkKind::Looks, bytes: 4 * u64::from(end - first), staged: Some(staged) };
        pace.submit(gpu, load, |encoder| {
            gpu.context.queue.write_buffer(&self.range.store.buffer, 0, &packed);
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline.pipeline);
            pass.set_bind_group(0, bound, &[]);
            pass.dispatch_workgroups(groups, 1, 1);
        })
    }
}
