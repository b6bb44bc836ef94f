//! What one picture is drawn from: `frame.wgsl`.

use weald::Error;
use weald::picture::Camera;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingType, BufferBindingType, BufferUsages, ShaderStages,
};

use super::lattice::{MOST_LEVELS, Standpoint};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Nearest distance that is drawn, in metres.
const NEAREST: f32 = 0.05;

/// The shader's struct.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Numbers {
    eye: [f32; 4],
    forward: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    stand: [f32; 4],
    slides: [[f32; 4]; MOST_LEVELS],
}

/// What a camera's ground was selected for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub(super) stand: Standpoint,
    pub(super) slides: [[f32; 4]; MOST_LEVELS],
}

/// The numbers of a picture on the device.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) layout: BindGroupLayout,
    pub(super) group: BindGroup,
    numbers: Store,
}

impl Frame {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let bytes = size_of::<Numbers>() as u64;
        let numbers = Store::new(gpu, "the numbers of a picture", bytes, usage)?;
        let entry = BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let description = BindGroupLayoutDescriptor { label: Some("frame"), entries: &[entry] };
        let layout = gpu.context.device.create_bind_group_layout(&description);
        let entries = [BindGroupEntry { binding: 0, resource: numbers.buffer.as_entire_binding() }];
        let description = BindGroupDescriptor { label: Some("frame"), layout: &layout, entries: &entries };
        let group = gpu
            .context
            .attempt("binding a picture", || Ok(gpu.context.device.create_bind_group(&description)))?;
        Ok(Self { layout, group, numbers })
    }

    /// Sets the numbers of the next picture.
    pub(super) fn write(&self, gpu: &Gpu, camera: &Camera, width: u32, drawn: &Drawn) {
        let with = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
        let [x, y] = drawn.stand.place;
        let numbers = Numbers {
            eye: with(camera.eye, camera.pixel_angle(width as usize)),
            forward: with(camera.forward, NEAREST),
            right: with(camera.right, camera.half[0]),
            up: with(camera.up, camera.half[1]),
            stand: [x, y, drawn.stand.above, 0.0],
            slides: drawn.slides,
        };
        gpu.context.queue.write_buffer(&self.numbers.buffer, 0, bytemuck::bytes_of(&numbers));
    }
}
