//! The textures and uniforms of a scene on the device.

use half::f16;
use weald::Error;
use weald::picture::{LitScene, SceneTexture, TextureKind};
use wgpu::{
    AddressMode, BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, BufferUsages, Extent3d,
    FilterMode, Origin3d, SamplerBindingType, SamplerDescriptor, ShaderStages, TexelCopyBufferLayout,
    TexelCopyTextureInfo, TextureAspect, TextureFormat, TextureSampleType, TextureUsages, TextureView,
    TextureViewDimension,
};

use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Binding of the first map; before it are the numbers and the sampler.
const FIRST_MAP: u32 = 2;

/// Rows of a map that go to the device at once, so that little is staged.
const ROWS: usize = 256;

/// All that shaders know of a scene.
#[derive(Debug)]
pub(super) struct Maps {
    pub(super) layout: BindGroupLayout,
    pub(super) group: BindGroup,
    numbers: Store,
    canvases: Vec<Canvas>,
}

impl Maps {
    pub(super) fn new(gpu: &Gpu, scene: &LitScene, maps: &[SceneTexture]) -> Result<Self, Error> {
        let bytes = scene.uniforms();
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let numbers = Store::new(gpu, "the numbers of a landscape", bytes.len() as u64, usage)?;
        gpu.context.queue.write_buffer(&numbers.buffer, 0, &bytes);
        let canvases: Vec<_> = maps.iter().map(|map| upload(gpu, map)).collect::<Result<_, _>>()?;
        let layout = layout(gpu);
        let group = bind(gpu, &layout, &numbers, &canvases)?;
        Ok(Self { layout, group, numbers, canvases })
    }

    /// The view of a map.
    pub(super) fn view(&self, name: &str) -> &TextureView {
        &self.canvas(name).view
    }

    /// Columns and rows of a map.
    pub(super) fn size(&self, name: &str) -> [usize; 2] {
        let texture = &self.canvas(name).texture;
        [texture.width() as usize, texture.height() as usize]
    }

    /// Makes room for a map, where the one that is there has another size.
    pub(super) fn make_room(&mut self, gpu: &Gpu, map: &SceneTexture) -> Result<(), Error> {
        let place = LitScene::texture_kinds().position(|(known, ..)| known == map.name);
        let (Some(place), false) = (place, self.size(map.name) == map.size) else { return Ok(()) };
        self.canvases[place] = room(gpu, map)?;
        self.group = bind(gpu, &self.layout, &self.numbers, &self.canvases)?;
        Ok(())
    }

    /// Sends some rows of a layer of a map, without waiting.
    pub(super) fn send(&self, gpu: &Gpu, name: &str, [layer, row]: [usize; 2], texels: Texels<'_>) {
        put_rows(gpu, self.canvas(name), [layer, row], (texels, &bytes(texels.kind, texels.values)));
    }

    /// Sends the numbers of a scene, without waiting.
    pub(super) fn send_numbers(&self, gpu: &Gpu, numbers: &[u8]) {
        gpu.context.queue.write_buffer(&self.numbers.buffer, 0, numbers);
    }

    fn canvas(&self, name: &str) -> &Canvas {
        let at = LitScene::texture_kinds().position(|(known, ..)| known == name);
        &self.canvases[at.expect("a map of the scene")]
    }
}

pub(super) fn format(kind: TextureKind) -> TextureFormat {
    match kind {
        TextureKind::Exact => TextureFormat::R32Float,
        TextureKind::Smooth => TextureFormat::Rgba16Float,
        TextureKind::Share => TextureFormat::R8Unorm,
    }
}

fn upload(gpu: &Gpu, map: &SceneTexture) -> Result<Canvas, Error> {
    let canvas = room(gpu, map)?;
    let values = Texels { kind: map.kind, columns: map.size[0], values: &map.values };
    write(gpu, &canvas, &values)?;
    Ok(canvas)
}

/// A texture for a map.
fn room(gpu: &Gpu, map: &SceneTexture) -> Result<Canvas, Error> {
    let size = map.size.map(|side| side as u32);
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    // Surfaces may follow a simulation.
    let usage = if map.kind == TextureKind::Exact { usage | TextureUsages::STORAGE_BINDING } else { usage };
    let shape = Shape {
        layers: map.layers as u32,
        is_array: is_array(map.name),
        ..Shape::flat(size, format(map.kind), usage)
    };
    Canvas::new(gpu, &format!("the map `{}`", map.name), shape)
}

/// The values of a texture, layer by layer, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Texels<'a> {
    pub(super) kind: TextureKind,
    pub(super) columns: usize,
    pub(super) values: &'a [f32],
}

/// Fills a texture, a few rows at a time.
pub(super) fn write(gpu: &Gpu, canvas: &Canvas, texels: &Texels<'_>) -> Result<(), Error> {
    let row = texels.columns * texels.kind.channels();
    let rows_of_a_layer = canvas.texture.height() as usize;
    for (layer, values) in texels.values.chunks(row * rows_of_a_layer).enumerate() {
        for (piece, values) in values.chunks(row * ROWS).enumerate() {
            write_rows(gpu, canvas, [layer, piece * ROWS], Texels { values, ..*texels })?;
        }
    }
    Ok(())
}

fn is_array(name: &str) -> bool {
    LitScene::texture_kinds().any(|(known, _, is_array)| known == name && is_array)
}

/// Writes some rows of a layer, and waits until they are there.
fn write_rows(gpu: &Gpu, canvas: &Canvas, place: [usize; 2], texels: Texels<'_>) -> Result<(), Error> {
    let bytes = bytes(texels.kind, texels.values);
    let _staged = gpu.memory.hold(bytes.len() as u64, "staging")?;
    let submission = gpu.context.attempt("bringing maps to the GPU", || {
        put_rows(gpu, canvas, place, (texels, &bytes));
        Ok(gpu.context.submit([]))
    })?;
    gpu.context.wait(Some(submission))
}

/// Writes some rows of a layer, whose texels are these bytes.
fn put_rows(
    gpu: &Gpu,
    canvas: &Canvas,
    [layer, row]: [usize; 2],
    (Texels { kind, columns, values }, bytes): (Texels<'_>, &[u8]),
) {
    let rows = values.len() / (columns * kind.channels());
    let place = TexelCopyTextureInfo {
        texture: &canvas.texture,
        mip_level: 0,
        origin: Origin3d { x: 0, y: row as u32, z: layer as u32 },
        aspect: TextureAspect::All,
    };
    let layout = TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((bytes.len() / rows) as u32),
        rows_per_image: None,
    };
    let size = Extent3d { width: columns as u32, height: rows as u32, depth_or_array_layers: 1 };
    gpu.context.queue.write_texture(place, bytes, layout, size);
}

fn bytes(kind: TextureKind, values: &[f32]) -> Vec<u8> {
    match kind {
        TextureKind::Exact => bytemuck::cast_slice(values).to_vec(),
        TextureKind::Smooth => values.iter().flat_map(|&value| f16::from_f32(value).to_le_bytes()).collect(),
        TextureKind::Share => {
            values.iter().map(|value| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8).collect()
        }
    }
}

fn layout(gpu: &Gpu) -> BindGroupLayout {
    let entry = |binding, ty| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT | ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let numbers = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let mut entries = vec![entry(0, numbers), entry(1, BindingType::Sampler(SamplerBindingType::Filtering))];
    entries.extend((FIRST_MAP..).zip(LitScene::texture_kinds()).map(|(binding, (_, kind, is_array))| {
        let filterable = kind != TextureKind::Exact;
        let view_dimension = if is_array { TextureViewDimension::D2Array } else { TextureViewDimension::D2 };
        let sample_type = TextureSampleType::Float { filterable };
        entry(binding, BindingType::Texture { sample_type, view_dimension, multisampled: false })
    }));
    let description = BindGroupLayoutDescriptor { label: Some("scene"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

fn bind(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    numbers: &Store,
    canvases: &[Canvas],
) -> Result<BindGroup, Error> {
    let clamp = AddressMode::ClampToEdge;
    let sampler = gpu.context.device.create_sampler(&SamplerDescriptor {
        label: Some("between"),
        address_mode_u: clamp,
        address_mode_v: clamp,
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    });
    let mut entries = vec![
        BindGroupEntry { binding: 0, resource: numbers.buffer.as_entire_binding() },
        BindGroupEntry { binding: 1, resource: BindingResource::Sampler(&sampler) },
    ];
    entries.extend((FIRST_MAP..).zip(canvases).map(|(binding, canvas)| BindGroupEntry {
        binding,
        resource: BindingResource::TextureView(&canvas.view),
    }));
    let description = BindGroupDescriptor { label: Some("scene"), layout, entries: &entries };
    gpu.context.attempt("binding maps", || Ok(gpu.context.device.create_bind_group(&description)))
}
