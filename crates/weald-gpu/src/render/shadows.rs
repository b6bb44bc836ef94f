//! The sun's depths: what throws shadows, drawn into each cascade.

use weald::Error;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBinding, BufferBindingType, BufferUsages,
    CommandEncoder, LoadOp, Operations, RenderPassDepthStencilAttachment, RenderPassDescriptor, ShaderStages,
    StoreOp, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

use super::cascades::{CASCADES, TEXELS};
use super::passes::{Casters, Drawing};
use super::targets::DEPTH;
use super::textures::{Canvas, Shape};
use super::timing::Timestamp;
use crate::gpu::Gpu;
use crate::memory::Store;

/// Bytes from the number of one cascade to that of the next, as bindings want it.
const APART: usize = 256;

/// The cascades on the device.
#[derive(Debug)]
pub(super) struct Shadows {
    pub(super) canvas: Canvas,
    pub(super) layout: BindGroupLayout,
    layers: Vec<(TextureView, BindGroup)>,
    /// Whether the last cascade, which no camera changes, is drawn.
    pub(super) whole_is_drawn: bool,
    _numbers: Store,
}

impl Shadows {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let shape =
            Shape { layers: CASCADES as u32, is_array: true, ..Shape::flat([TEXELS; 2], DEPTH, usage) };
        let canvas = Canvas::new(gpu, "shadows", shape)?;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let numbers = Store::new(gpu, "the numbers of cascades", (APART * CASCADES) as u64, usage)?;
        let mut bytes = vec![0; APART * CASCADES];
        (0..CASCADES).for_each(|cascade| bytes[APART * cascade] = cascade as u8);
        gpu.context.queue.write_buffer(&numbers.buffer, 0, &bytes);
        let entry = BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::VERTEX,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let label = Some("cascade");
        let layout = gpu
            .context
            .device
            .create_bind_group_layout(&BindGroupLayoutDescriptor { label, entries: &[entry] });
        let layers = (0..CASCADES).map(|cascade| layer(gpu, &canvas, (&layout, &numbers), cascade)).collect();
        Ok(Self { canvas, layout, layers, whole_is_drawn: false, _numbers: numbers })
    }

    /// Draws what throws shadows into all cascades; into the last, of which the groups are the second ones, once.
    pub(super) fn draw(
        &mut self,
        encoder: &mut CommandEncoder,
        groups: [[&BindGroup; 2]; 2],
        casters: &Casters,
        drawing: Drawing<'_>,
    ) {
        if !self.whole_is_drawn {
            self.draw_cascade(encoder, groups[1], (casters, CASCADES - 1), drawing);
        }
        self.whole_is_drawn = !drawing.casts_nothing;
        (0..CASCADES - 1).for_each(|cascade| {
            self.draw_cascade(encoder, groups[0], (casters, cascade), drawing);
        });
    }

    fn draw_cascade(
        &self,
        encoder: &mut CommandEncoder,
        groups: [&BindGroup; 2],
        (casters, number): (&Casters, usize),
        Drawing { terrain, plants, casts_nothing, timer, .. }: Drawing<'_>,
    ) {
        let (view, cascade) = &self.layers[number];
        let depth = Operations { load: LoadOp::Clear(1.0), store: StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("shadows"),
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(depth),
                stencil_ops: None,
            }),
            timestamp_writes: timer
                .filter(|_| number == 0)
                .map(|timer| timer.around(Timestamp::Shadows, [true, false])),
            ..RenderPassDescriptor::default()
        });
        if casts_nothing {
            return;
        }
        for (at, group) in (0..).zip([groups[0], groups[1], cascade]) {
            pass.set_bind_group(at, group, &[]);
        }
        casters.draw(&mut pass, terrain, number + 1);
        if let Some(plants) = plants {
            plants.cast(&mut pass, number);
        }
    }
}

/// A cascade to be drawn, and its number as shaders see it.
fn layer(
    gpu: &Gpu,
    canvas: &Canvas,
    (layout, numbers): (&BindGroupLayout, &Store),
    cascade: usize,
) -> (TextureView, BindGroup) {
    let view = canvas.texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2),
        base_array_layer: cascade as u32,
        array_layer_count: Some(1),
        ..TextureViewDescriptor::default()
    });
    let resource = BindingResource::Buffer(BufferBinding {
        buffer: &numbers.buffer,
        offset: (APART * cascade) as u64,
        size: std::num::NonZero::new(16),
    });
    let entries = [BindGroupEntry { binding: 0, resource }];
    let description = BindGroupDescriptor { label: Some("cascade"), layout, entries: &entries };
    (view, gpu.context.device.create_bind_group(&description))
}
