//! The pipelines of plants and what they are bound to.

use weald::Error;
use weald::grow::{ifs::limbs, wind};
use weald::picture::LitScene;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, ColorTargetState, ColorWrites,
    CompareFunction, ComputePipeline, ComputePipelineDescriptor, FragmentState, MultisampleState,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, PrimitiveState, RenderPipeline,
    RenderPipelineDescriptor, ShaderModule, ShaderStages, VertexAttribute, VertexBufferLayout, VertexState,
    VertexStepMode, vertex_attr_array,
};

use super::lists::VIEWS;
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::render::cascades::TEXELS;
use crate::render::layouts::{Layouts, STAGE_GROUP, depth_state, shared};
use crate::render::records::{READ, Records, WRITTEN};
use crate::render::targets::LIGHT;
use crate::slots::Slots;

/// Entry points that sort plants into lists, in their order.
const CHOOSE: [&str; 3] = ["count_plants", "line_up", "place_plants"];

/// Words of a corner with its limb.
pub(super) const VERTEX_WORDS: usize = 20;

/// A corner with its limb, as `leaves.wgsl` has it.
const CORNER: [VertexAttribute; 8] = vertex_attr_array![
    0 => Float32x4, 1 => Float32x3, 2 => Uint32, 3 => Float32x3, 4 => Uint32, 5 => Float32x4, 6 => Float32x3, 7 => Uint32
];

/// Where lists start, each a number that all vertices share.
const STARTS: [[VertexAttribute; 1]; 2] = [vertex_attr_array![8 => Uint32], vertex_attr_array![9 => Uint32]];

/// The layouts of what a set of plants is bound to.
#[derive(Debug)]
pub(super) struct Groups {
    choose: BindGroupLayout,
    carry: BindGroupLayout,
    draw: BindGroupLayout,
    stand: BindGroupLayout,
}

impl Groups {
    fn new(gpu: &Gpu) -> Self {
        Self {
            choose: layout(gpu, ShaderStages::COMPUTE, &[true, false, false, false, false], &[WRITTEN]),
            carry: layout(gpu, ShaderStages::COMPUTE, &[true, true, true, true, false], &[READ, WRITTEN]),
            draw: layout(gpu, ShaderStages::VERTEX_FRAGMENT, &[], &[READ, READ]),
            stand: layout(gpu, ShaderStages::COMPUTE, &[false], &[]),
        }
    }

    /// With the texture for plants as they are seen.
    pub(super) fn choose(&self, gpu: &Gpu, stores: &[&Store], seen: &Records) -> Result<BindGroup, Error> {
        bind(gpu, &self.choose, stores, &[seen.resource()])
    }

    /// With the texture of limbs, and the one for how they are carried.
    pub(super) fn carry(
        &self,
        gpu: &Gpu,
        stores: &[&Store],
        textures: &[BindingResource<'_>; 2],
    ) -> Result<BindGroup, Error> {
        bind(gpu, &self.carry, stores, textures)
    }

    /// With the textures of how limbs are carried, and of plants as they are seen.
    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        kind: &Store,
        textures: &[BindingResource<'_>; 2],
    ) -> Result<BindGroup, Error> {
        bind(gpu, &self.draw, &[kind], textures)
    }

    pub(super) fn stand(&self, gpu: &Gpu, stores: &[&Store]) -> Result<BindGroup, Error> {
        bind(gpu, &self.stand, stores, &[])
    }
}

/// All pipelines of plants.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub(super) choose: [ComputePipeline; 3],
    pub(super) carry: ComputePipeline,
    pub(super) stand: ComputePipeline,
    /// Of the trees of woods.
    pub(super) grow: ComputePipeline,
    /// Of whole leaves, and of those that are divided into leaflets.
    pub(super) light: [RenderPipeline; 2],
    pub(super) caster: RenderPipeline,
    pub(super) groups: Groups,
    /// Numbers of all views, of which a draw is bound to one.
    pub(super) which: BindGroup,
    pub(super) numbers: Slots,
}

/// What a pipeline that draws is made of.
struct Drawn<'a> {
    module: &'a ShaderModule,
    layout: PipelineLayout,
    samples: u32,
}

impl Pipelines {
    pub(super) fn new(
        gpu: &Gpu,
        scene: &LitScene,
        layouts: Layouts<'_>,
        samples: u32,
    ) -> Result<Self, Error> {
        let device = &gpu.context.device;
        let groups = Groups::new(gpu);
        let numbers = numbers(gpu)?;
        let which_layout = which_layout(gpu);
        let which = which(gpu, &which_layout, &numbers)?;
        let (choose, carry, stand, grow, light, caster) =
            gpu.context.attempt_to_compile("making the pipelines of plants", || {
                let standing = module(gpu, scene, &[include_str!("stand.wgsl")]);
                let grown = module_of(gpu, scene.shader(STAGE_GROUP), &[include_str!("wood.wgsl")]);
                let swaying = [
                    wind::FUNCTIONS,
                    limbs::FUNCTIONS,
                    include_str!("carried.wgsl"),
                    include_str!("seen.wgsl"),
                ];
                let chosen = module(gpu, scene, &[&swaying[..], &[include_str!("choose.wgsl")]].concat());
                let carried = [&swaying[..], &[include_str!("carry.wgsl")]].concat();
                let carried = module(gpu, scene, &carried);
                let leaves = [
                    include_str!("../thin.wgsl"),
                    include_str!("bark.wgsl"),
                    include_str!("leaflets.wgsl"),
                    include_str!("leaves.wgsl"),
                ];
                let leaves = module(gpu, scene, &[&swaying[..], &leaves].concat());
                let (frame, maps) = (layouts.frame, &layouts.maps.layout);
                let whole = |groups: &[Option<&BindGroupLayout>]| {
                    device.create_pipeline_layout(&PipelineLayoutDescriptor {
                        label: Some("plants"),
                        bind_group_layouts: groups,
                        immediate_size: 0,
                    })
                };
                let choosing = whole(&[Some(&frame.caster_layout), Some(maps), Some(&groups.choose)]);
                let carrying = whole(&[Some(&frame.caster_layout), Some(maps), Some(&groups.carry)]);
                let put = whole(&[Some(&frame.caster_layout), Some(maps), Some(&groups.stand)]);
                let drawn = |frame, samples| Drawn {
                    module: &leaves,
                    layout: whole(&[Some(frame), Some(maps), Some(&groups.draw), Some(&which_layout)]),
                    samples,
                };
                Ok((
                    CHOOSE.map(|name| compute(gpu, &chosen, &choosing, name)),
                    compute(gpu, &carried, &carrying, "carry_limbs"),
                    compute(gpu, &standing, &put, "stand"),
                    compute(gpu, &grown, &put, "grow_wood"),
                    ["leaf_fragment", "divided_fragment"]
                        .map(|name| light(gpu, &drawn(&frame.layout, samples), name)),
                    caster(gpu, &drawn(&frame.caster_layout, 1)),
                ))
            })?;
        Ok(Self { choose, carry, stand, grow, light, caster, groups, which, numbers })
    }
}

/// A module of what all shaders of plants share, and its own parts.
fn module(gpu: &Gpu, scene: &LitScene, own: &[&str]) -> ShaderModule {
    module_of(gpu, scene.shader_of_light(STAGE_GROUP), own)
}

/// The same with such functions of the view.
fn module_of(gpu: &Gpu, of_view: String, own: &[&str]) -> ShaderModule {
    let texels = format!("const SHADOW_TEXELS = {TEXELS}u;");
    let shared = [
        texels.as_str(),
        include_str!("../frame.wgsl"),
        include_str!("../records.wgsl"),
        include_str!("../shadows.wgsl"),
        include_str!("plants.wgsl"),
    ];
    let parts = shared.iter().chain(own);
    let text = parts.fold(of_view, |text, part| text + "\n" + part);
    gpu.context.known.module(&gpu.context.device, "plants", text)
}

/// The view of every draw.
fn numbers(gpu: &Gpu) -> Result<Slots, Error> {
    let numbers = Slots::new(gpu, "numbers of views", 1, VIEWS)?;
    let views: Vec<_> = (0..VIEWS as u32).map(|view| [view]).collect();
    let packed = numbers.packed(views.iter().map(<[u32; 1]>::as_slice))?;
    crate::transfer::write(gpu, &numbers.store.buffer, &packed)?;
    Ok(numbers)
}

fn which(gpu: &Gpu, layout: &BindGroupLayout, numbers: &Slots) -> Result<BindGroup, Error> {
    let entries = [BindGroupEntry { binding: 0, resource: numbers.binding() }];
    let description = BindGroupDescriptor { label: Some("a view"), layout, entries: &entries };
    gpu.context.attempt("binding a view", || Ok(gpu.context.device.create_bind_group(&description)))
}

fn which_layout(gpu: &Gpu) -> BindGroupLayout {
    let ty = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: true,
        min_binding_size: None,
    };
    let entry = BindGroupLayoutEntry { binding: 0, visibility: ShaderStages::VERTEX, ty, count: None };
    let description = BindGroupLayoutDescriptor { label: Some("a view"), entries: &[entry] };
    gpu.context.device.create_bind_group_layout(&description)
}

/// A uniform, buffers of which some are only read, and textures behind them.
fn layout(
    gpu: &Gpu,
    visibility: ShaderStages,
    read_only: &[bool],
    textures: &[BindingType],
) -> BindGroupLayout {
    let storage = read_only.iter().map(|&read_only| BufferBindingType::Storage { read_only });
    let buffers = [BufferBindingType::Uniform].into_iter().chain(storage);
    let buffers =
        buffers.map(|ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None });
    let entries = (0..).zip(buffers.chain(textures.iter().copied()));
    let entries: Vec<_> =
        entries.map(|(binding, ty)| BindGroupLayoutEntry { binding, visibility, ty, count: None }).collect();
    let description = BindGroupLayoutDescriptor { label: Some("plants"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

fn bind(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    stores: &[&Store],
    textures: &[BindingResource<'_>],
) -> Result<BindGroup, Error> {
    let buffers = stores.iter().map(|store| store.buffer.as_entire_binding());
    let entries = (0..).zip(buffers.chain(textures.iter().cloned()));
    let entries: Vec<_> = entries.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
    let description = BindGroupDescriptor { label: Some("plants"), layout, entries: &entries };
    gpu.context.attempt("binding plants", || Ok(gpu.context.device.create_bind_group(&description)))
}

fn compute(gpu: &Gpu, module: &ShaderModule, layout: &PipelineLayout, name: &str) -> ComputePipeline {
    let description = ComputePipelineDescriptor {
        label: Some(name),
        layout: Some(layout),
        module,
        entry_point: Some(name),
        compilation_options: PipelineCompilationOptions::default(),
        cache: None,
    };
    let make = || gpu.context.device.create_compute_pipeline(&description);
    gpu.context.known.computing((module.clone(), name.to_owned()), make)
}

fn light(gpu: &Gpu, drawn: &Drawn<'_>, entry_point: &str) -> RenderPipeline {
    let target = ColorTargetState { format: LIGHT, blend: None, write_mask: ColorWrites::ALL };
    let fragment = FragmentState {
        module: drawn.module,
        entry_point: Some(entry_point),
        compilation_options: PipelineCompilationOptions::default(),
        targets: &[Some(target)],
    };
    pipeline(gpu, drawn, ("leaf_vertex", CompareFunction::Greater), Some(fragment))
}

fn caster(gpu: &Gpu, drawn: &Drawn<'_>) -> RenderPipeline {
    pipeline(gpu, drawn, ("leaf_caster", CompareFunction::Less), None)
}

fn pipeline(
    gpu: &Gpu,
    drawn: &Drawn<'_>,
    (vertex, compare): (&str, CompareFunction),
    fragment: Option<FragmentState<'_>>,
) -> RenderPipeline {
    let seen = fragment.as_ref().and_then(|fragment| fragment.entry_point).unwrap_or_default();
    let key = format!("{vertex} {seen} {}", drawn.samples);
    let make = || {
        gpu.context.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(vertex),
            layout: Some(&drawn.layout),
            vertex: VertexState {
                module: drawn.module,
                entry_point: Some(vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[
                    Some(VertexBufferLayout {
                        array_stride: 4 * VERTEX_WORDS as u64,
                        step_mode: VertexStepMode::Vertex,
                        attributes: &CORNER,
                    }),
                    Some(shared(&STARTS[0])),
                    Some(shared(&STARTS[1])),
                ],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: Some(depth_state(true, compare)),
            multisample: MultisampleState { count: drawn.samples, ..MultisampleState::default() },
            fragment,
            multiview_mask: None,
            cache: None,
        })
    };
    gpu.context.known.drawing((drawn.module.clone(), key), make)
}
