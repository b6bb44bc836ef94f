//! The pipelines of plants and what they are bound to.

use weald::Error;
use weald::grow::{ifs::limbs, wind};
use weald::picture::LitScene;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingType, BufferBindingType, ColorTargetState, ColorWrites, CompareFunction,
    ComputePipeline, ComputePipelineDescriptor, FragmentState, MultisampleState, PipelineCompilationOptions,
    PipelineLayout, PipelineLayoutDescriptor, PrimitiveState, RenderPipeline, RenderPipelineDescriptor,
    ShaderModule, ShaderStages, VertexState,
};

use super::lists::{LISTS, VIEWS};
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::render::cascades::TEXELS;
use crate::render::layouts::{Layouts, STAGE_GROUP, depth_state};
use crate::render::targets::LIGHT;
use crate::slots::Slots;

/// Entry points that sort plants into lists, in their order.
const CHOOSE: [&str; 3] = ["count_plants", "line_up", "place_plants"];

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
            choose: layout(gpu, ShaderStages::COMPUTE, &[true, false, false, false, false]),
            carry: layout(gpu, ShaderStages::COMPUTE, &[true, true, true, true, true, false]),
            draw: layout(gpu, ShaderStages::VERTEX_FRAGMENT, &[true; 6]),
            stand: layout(gpu, ShaderStages::COMPUTE, &[false]),
        }
    }

    pub(super) fn choose(&self, gpu: &Gpu, stores: &[&Store]) -> Result<BindGroup, Error> {
        bind(gpu, &self.choose, stores)
    }

    pub(super) fn carry(&self, gpu: &Gpu, stores: &[&Store]) -> Result<BindGroup, Error> {
        bind(gpu, &self.carry, stores)
    }

    pub(super) fn draw(&self, gpu: &Gpu, stores: &[&Store]) -> Result<BindGroup, Error> {
        bind(gpu, &self.draw, stores)
    }

    pub(super) fn stand(&self, gpu: &Gpu, stores: &[&Store]) -> Result<BindGroup, Error> {
        bind(gpu, &self.stand, stores)
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
    pub(super) light: RenderPipeline,
    pub(super) caster: RenderPipeline,
    pub(super) groups: Groups,
    /// Numbers of all views and lists, of which a draw is bound to one.
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
                let chosen = module(gpu, scene, &[include_str!("choose.wgsl")]);
                let standing = module(gpu, scene, &[include_str!("stand.wgsl")]);
                let grown = module_of(gpu, scene.shader(STAGE_GROUP), &[include_str!("wood.wgsl")]);
                let swaying = [wind::FUNCTIONS, limbs::FUNCTIONS, include_str!("carried.wgsl")];
                let carried = [&swaying[..], &[include_str!("carry.wgsl")]].concat();
                let carried = module(gpu, scene, &carried);
                let leaves = [include_str!("../thin.wgsl"), include_str!("leaves.wgsl")];
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
                    light(gpu, &drawn(&frame.layout, samples)),
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
        include_str!("../shadows.wgsl"),
        include_str!("plants.wgsl"),
    ];
    let parts = shared.iter().chain(own);
    let text = parts.fold(of_view, |text, part| text + "\n" + part);
    gpu.context.known.module(&gpu.context.device, "plants", text)
}

/// The view and the list of every draw.
fn numbers(gpu: &Gpu) -> Result<Slots, Error> {
    let numbers = Slots::new(gpu, "numbers of lists", 2, VIEWS * LISTS)?;
    let pairs: Vec<_> = (0..VIEWS * LISTS).map(|n| [(n / LISTS) as u32, (n % LISTS) as u32]).collect();
    let packed = numbers.packed(pairs.iter().map(<[u32; 2]>::as_slice))?;
    crate::transfer::write(gpu, &numbers.store.buffer, &packed)?;
    Ok(numbers)
}

fn which(gpu: &Gpu, layout: &BindGroupLayout, numbers: &Slots) -> Result<BindGroup, Error> {
    let entries = [BindGroupEntry { binding: 0, resource: numbers.binding() }];
    let description = BindGroupDescriptor { label: Some("a list"), layout, entries: &entries };
    gpu.context.attempt("binding a list", || Ok(gpu.context.device.create_bind_group(&description)))
}

fn which_layout(gpu: &Gpu) -> BindGroupLayout {
    let ty = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: true,
        min_binding_size: None,
    };
    let entry = BindGroupLayoutEntry { binding: 0, visibility: ShaderStages::VERTEX, ty, count: None };
    let description = BindGroupLayoutDescriptor { label: Some("a list"), entries: &[entry] };
    gpu.context.device.create_bind_group_layout(&description)
}

/// A uniform, and buffers of which some are only read.
fn layout(gpu: &Gpu, visibility: ShaderStages, read_only: &[bool]) -> BindGroupLayout {
    let storage = read_only.iter().map(|&read_only| BufferBindingType::Storage { read_only });
    let kinds = [BufferBindingType::Uniform].into_iter().chain(storage);
    let entries = (0..).zip(kinds).map(|(binding, ty)| BindGroupLayoutEntry {
        binding,
        visibility,
        ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    });
    let entries: Vec<_> = entries.collect();
    let description = BindGroupLayoutDescriptor { label: Some("plants"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

fn bind(gpu: &Gpu, layout: &BindGroupLayout, stores: &[&Store]) -> Result<BindGroup, Error> {
    let entries = (0..).zip(stores);
    let entries: Vec<_> = entries
        .map(|(binding, store)| BindGroupEntry { binding, resource: store.buffer.as_entire_binding() })
        .collect();
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

fn light(gpu: &Gpu, drawn: &Drawn<'_>) -> RenderPipeline {
    let target = ColorTargetState { format: LIGHT, blend: None, write_mask: ColorWrites::ALL };
    let fragment = FragmentState {
        module: drawn.module,
        entry_point: Some("leaf_fragment"),
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
    let make = || {
        gpu.context.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(vertex),
            layout: Some(&drawn.layout),
            vertex: VertexState {
                module: drawn.module,
                entry_point: Some(vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: Some(depth_state(true, compare)),
            multisample: MultisampleState { count: drawn.samples, ..MultisampleState::default() },
            fragment,
            multiview_mask: None,
            cache: None,
        })
    };
    gpu.context.known.drawing((drawn.module.clone(), format!("{vertex} {}", drawn.samples)), make)
}
