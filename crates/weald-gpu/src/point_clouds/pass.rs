//! A shader of plants over a piece of points, in submissions that leave the device free for others.

use weald::Error;
use weald::engine::uniform::Uniform;
use weald::grow::ifs::device::DispatchRange;
use weald::grow::ifs::shader::Shader;
use wgpu::{BindGroup, Buffer, BufferUsages, ComputePassDescriptor};

use crate::compiled::Pipeline;
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::{Load, Pace, WorkKind};
use crate::slots::Slots;
use crate::transfer;

/// A shader that can be dispatched.
#[derive(Debug)]
pub(crate) struct Pass {
    pipeline: Pipeline,
    range: Slots,
}

/// What a pass does with a piece.
#[derive(Debug)]
pub(crate) struct Work<'a> {
    pub(crate) bound: &'a BindGroup,
    /// Points of the piece.
    pub(crate) points: u32,
    /// Points of a workgroup.
    pub(crate) of_a_group: u32,
    /// Bytes that each point moves.
    pub(crate) bytes: u64,
    /// A uniform that is written before the first dispatch.
    pub(crate) given: Option<(&'a Slots, Vec<u8>)>,
}

impl Pass {
    pub(crate) fn new(gpu: &Gpu, shader: &Shader) -> Result<Self, Error> {
        let words = DispatchRange { first: 0, points: 0 }.words().len();
        let range = Slots::new(gpu, "the range of a dispatch", words, 1)?;
        Ok(Self { pipeline: Pipeline::of_plants(gpu, shader)?, range })
    }

    /// Binds uniforms, the stretch behind them, and buffers, in the order of the shader's lists.
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        uniforms: &[&Slots],
        buffers: &[&Store],
    ) -> Result<BindGroup, Error> {
        let uniforms = uniforms.iter().copied().chain([&self.range]).map(Slots::binding);
        let buffers = buffers.iter().map(|store| store.buffer.as_entire_binding());
        self.pipeline.bind(gpu, (0..).zip(uniforms.chain(buffers)).collect())
    }

    /// Submits all workgroups.
    pub(crate) fn run(&self, gpu: &Gpu, pace: &mut Pace, mut work: Work<'_>) -> Result<(), Error> {
        let groups = work.points.div_ceil(work.of_a_group);
        let group_bytes = work.bytes * u64::from(work.of_a_group);
        let mut first = 0;
        while first < groups {
            let fitting = (pace.allowance(WorkKind::Passes) / group_bytes).max(1);
            let count = fitting.min(u64::from(groups - first)) as u32;
            let range = DispatchRange { first, points: work.points };
            let mut given = vec![(&self.range, packed(&self.range, &range)?)];
            given.extend(work.given.take());
            let staged =
                gpu.memory.hold(given.iter().map(|(_, bytes)| bytes.len() as u64).sum(), "staging")?;
            let bytes = group_bytes * u64::from(count);
            pace.submit(gpu, Load { sort: WorkKind::Passes, bytes, staged: Some(staged) }, |encoder| {
                for (slots, bytes) in &given {
                    gpu.context.queue.write_buffer(&slots.store.buffer, 0, bytes);
                }
                let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
                pass.set_pipeline(&self.pipeline.pipeline);
                pass.set_bind_group(0, work.bound, &[]);
                pass.dispatch_workgroups(count, 1, 1);
            })?;
            first += count;
        }
        Ok(())
    }
}

/// A uniform as it lies in its only slot.
pub(crate) fn packed(slots: &Slots, uniform: &impl Uniform) -> Result<Vec<u8>, Error> {
    slots.packed(std::iter::once(uniform.words().as_slice()))
}

/// A slot that holds a uniform.
pub(crate) fn uniform(gpu: &Gpu, what: &str, uniform: &impl Uniform) -> Result<Slots, Error> {
    let slots = Slots::new(gpu, what, uniform.words().len(), 1)?;
    transfer::write(gpu, &slots.store.buffer, &packed(&slots, uniform)?)?;
    Ok(slots)
}

/// A buffer that holds a table.
pub(crate) fn table<T: bytemuck::NoUninit>(gpu: &Gpu, what: &str, values: &[T]) -> Result<Store, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(values);
    let store = Store::new(gpu, what, bytes.len() as u64, BufferUsages::STORAGE | BufferUsages::COPY_DST)?;
    overwrite(gpu, &store.buffer, values)?;
    Ok(store)
}

/// Other values for a table.
pub(crate) fn overwrite<T: bytemuck::NoUninit>(gpu: &Gpu, into: &Buffer, values: &[T]) -> Result<(), Error> {
    transfer::write(gpu, into, bytemuck::cast_slice(values))
}
