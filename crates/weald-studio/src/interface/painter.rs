//! Buffers and the pipeline of the interface.

use std::num::NonZeroU64;

use eframe::egui::epaint::{Mesh, Vertex};
use eframe::wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingType, BlendComponent, BlendFactor, BlendOperation, BlendState, Buffer,
    BufferBindingType, BufferDescriptor, BufferUsages, ColorTargetState, ColorWrites, Device, FragmentState,
    IndexFormat, MultisampleState, PipelineCompilationOptions, PipelineLayoutDescriptor, PrimitiveState,
    Queue, RenderPass, RenderPipeline, RenderPipelineDescriptor, SamplerBindingType, ShaderModule,
    ShaderStages, TextureFormat, TextureSampleType, TextureViewDimension, VertexBufferLayout, VertexState,
    VertexStepMode, include_wgsl, vertex_attr_array,
};

/// What draws the triangles of a frame.
pub(super) struct Painter {
    pipeline: RenderPipeline,
    window: Buffer,
    group: BindGroup,
    vertices: Growing,
    indices: Growing,
}

impl Painter {
    /// For windows of this format.
    pub(super) fn new(device: &Device, format: TextureFormat) -> Self {
        let layouts = [window_layout(device), texture_layout(device)];
        let window = device.create_buffer(&BufferDescriptor {
            label: Some("size of the window"),
            size: 16,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("window"),
            layout: &layouts[0],
            entries: &[BindGroupEntry { binding: 0, resource: window.as_entire_binding() }],
        });
        let pipeline = pipeline(device, &layouts, format);
        let [vertices, indices] = [BufferUsages::VERTEX, BufferUsages::INDEX].map(Growing::new);
        Self { pipeline, window, group, vertices, indices }
    }

    /// Brings the triangles of a frame to the device, one mesh after the other, for a window of so many points.
    pub(super) fn write<'a>(
        &mut self,
        (device, queue): (&Device, &Queue),
        points: [f32; 2],
        meshes: impl Iterator<Item = &'a Mesh> + Clone,
    ) {
        let vertices: Vec<Vertex> = meshes.clone().flat_map(|mesh| mesh.vertices.iter().copied()).collect();
        let indices: Vec<u32> = meshes.flat_map(|mesh| mesh.indices.iter().copied()).collect();
        self.vertices.write(device, queue, bytemuck::cast_slice(&vertices));
        self.indices.write(device, queue, bytemuck::cast_slice(&indices));
        queue.write_buffer(&self.window, 0, bytemuck::bytes_of(&[points[0], points[1], 0.0, 0.0]));
    }

    /// Sets all that the pieces share.
    pub(super) fn begin(&self, pass: &mut RenderPass<'static>) {
        let (Some(vertices), Some(indices)) = (&self.vertices.buffer, &self.indices.buffer) else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
    }
}

/// A buffer that grows with what is written into it.
struct Growing {
    buffer: Option<Buffer>,
    usage: BufferUsages,
}

impl Growing {
    fn new(usage: BufferUsages) -> Self {
        Self { buffer: None, usage }
    }

    fn write(&mut self, device: &Device, queue: &Queue, bytes: &[u8]) {
        let wanted = bytes.len().max(1 << 16) as u64;
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < wanted) {
            self.buffer = Some(device.create_buffer(&BufferDescriptor {
                label: Some("triangles of the interface"),
                size: wanted.next_power_of_two(),
                usage: self.usage | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        if let Some(buffer) = &self.buffer {
            queue.write_buffer(buffer, 0, bytes);
        }
    }
}

fn uniform(bytes: u64) -> BindingType {
    BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(bytes),
    }
}

fn entry(binding: u32, visibility: ShaderStages, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn window_layout(device: &Device) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("window"),
        entries: &[entry(0, ShaderStages::VERTEX, uniform(16))],
    })
}

/// The layout that `egui_wgpu` gives its textures: theirs are bound here.
fn texture_layout(device: &Device) -> BindGroupLayout {
    let texture = BindingType::Texture {
        multisampled: false,
        sample_type: TextureSampleType::Float { filterable: true },
        view_dimension: TextureViewDimension::D2,
    };
    let kinds = [texture, BindingType::Sampler(SamplerBindingType::Filtering), uniform(16)];
    let entries: Vec<_> =
        (0..).zip(kinds).map(|(binding, kind)| entry(binding, ShaderStages::FRAGMENT, kind)).collect();
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("texture of the interface"),
        entries: &entries,
    })
}

fn pipeline(device: &Device, layouts: &[BindGroupLayout; 2], format: TextureFormat) -> RenderPipeline {
    let module = device.create_shader_module(include_wgsl!("interface.wgsl"));
    let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some("interface"),
        bind_group_layouts: &[Some(&layouts[0]), Some(&layouts[1])],
        immediate_size: 0,
    });
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("interface"),
        layout: Some(&layout),
        vertex: VertexState {
            module: &module,
            entry_point: Some("corner"),
            buffers: &[Some(VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: VertexStepMode::Vertex,
                attributes: &vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Unorm8x4],
            })],
            compilation_options: PipelineCompilationOptions::default(),
        },
        primitive: PrimitiveState::default(),
        depth_stencil: None,
        multisample: MultisampleState::default(),
        fragment: Some(fragment(&module, &target(format))),
        multiview_mask: None,
        cache: None,
    })
}

fn fragment<'a>(module: &'a ShaderModule, target: &'a [Option<ColorTargetState>; 1]) -> FragmentState<'a> {
    FragmentState {
        module,
        entry_point: Some("pixel"),
        targets: target,
        compilation_options: PipelineCompilationOptions::default(),
    }
}

/// Colours are multiplied by their opacity already.
fn target(format: TextureFormat) -> [Option<ColorTargetState>; 1] {
    let part =
        |src_factor, dst_factor| BlendComponent { src_factor, dst_factor, operation: BlendOperation::Add };
    let blend = BlendState {
        color: part(BlendFactor::One, BlendFactor::OneMinusSrcAlpha),
        alpha: part(BlendFactor::OneMinusDstAlpha, BlendFactor::One),
    };
    [Some(ColorTargetState { format, blend: Some(blend), write_mask: ColorWrites::ALL })]
}
