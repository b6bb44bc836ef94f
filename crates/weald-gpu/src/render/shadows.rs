//! The sun's depths: what throws shadows, drawn into each cascade when that has become another one.

use weald::Error;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBinding, BufferBindingType, BufferUsages,
    CommandEncoder, LoadOp, Operations, RenderPassDepthStencilAttachment, RenderPassDescriptor, ShaderStages,
    StoreOp, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

use super::cascades::{CASCADES, NOWHERE, TEXELS};
use super::casters::Casters;
use super::frame::Drawn;
use super::passes::Drawing;
use super::targets::DEPTH;
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Bytes from the number of one cascade to that of the next, as bindings want it.
const APART: usize = 256;

/// What a cascade hangs on beside the landscape, which is forgotten with [`Shadows::forget`]: where it is, from where and for
/// pixels of which angle its detail is chosen, how far trees of woods stand, and the moment by which plants sway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CascadeContent {
    square: [f32; 4],
    depths: [f32; 2],
    from: [f32; 4],
    pixel_angle: f32,
    woods: f32,
    seconds: f32,
}

impl CascadeContent {
    /// Of each cascade in a picture; no camera changes the last.
    pub(super) fn of(drawn: &Drawn, pixel_angle: f32) -> [Self; CASCADES] {
        let Drawn { cascades, woods, seconds, .. } = *drawn;
        std::array::from_fn(|number| {
            let (square, depths) = (cascades.squares[number], cascades.depths);
            match cascades.detail_points.get(number) {
                Some(&from) => Self { square, depths, from, pixel_angle, woods, seconds },
                None => Self { square, depths, from: [0.0; 4], pixel_angle: 0.0, woods: 0.0, seconds: 0.0 },
            }
        })
    }
}

/// The cascades on the device.
#[derive(Debug)]
pub(super) struct Shadows {
    pub(super) canvas: Canvas,
    pub(super) layout: BindGroupLayout,
    layers: Vec<(TextureView, BindGroup)>,
    /// What is drawn into each.
    drawn: [Option<CascadeContent>; CASCADES],
    /// Whether that is nothing.
    is_empty: [bool; CASCADES],
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
        Ok(Self {
            canvas,
            layout,
            layers,
            drawn: [None; CASCADES],
            is_empty: [false; CASCADES],
            _numbers: numbers,
        })
    }

    /// Has all cascades drawn anew for the next picture: what throws shadows has changed.
    pub(super) fn forget(&mut self) {
        self.drawn = [None; CASCADES];
    }

    /// The cascades that are not as a picture wants them; in one that is nowhere nothing is looked up.
    pub(super) fn stale(&self, wanted: &[CascadeContent; CASCADES]) -> [bool; CASCADES] {
        std::array::from_fn(|number| {
            wanted[number].square != NOWHERE && self.drawn[number] != Some(wanted[number])
        })
    }

    /// Draws what throws shadows into cascades, by their numbers and those of the landscape.
    pub(super) fn draw(
        &mut self,
        encoder: &mut CommandEncoder,
        (numbers, maps): (&[BindGroup; CASCADES], &BindGroup),
        (casters, wanted): (&Casters, &[CascadeContent; CASCADES]),
        drawing: Drawing<'_>,
    ) {
        let stale = self.stale(wanted);
        for number in (0..CASCADES).filter(|&number| stale[number]) {
            let is_empty = drawing.terrain.is_nothing_in(number);
            if !(is_empty && self.is_empty[number]) {
                self.draw_cascade(encoder, [&numbers[number], maps], (casters, number), drawing);
            }
            self.is_empty[number] = is_empty;
            self.drawn[number] = Some(wanted[number]).filter(|_| !drawing.casts_nothing);
        }
    }

    fn draw_cascade(
        &self,
        encoder: &mut CommandEncoder,
        groups: [&BindGroup; 2],
        (casters, number): (&Casters, usize),
        Drawing { terrain, plants, casts_nothing, .. }: Drawing<'_>,
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
