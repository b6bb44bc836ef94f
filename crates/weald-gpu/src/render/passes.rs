//! The pipelines that draw light, and their order.

use weald::Error;
use weald::picture::LitScene;
use wgpu::{
    BindGroup, BindGroupLayout, ColorTargetState, ColorWrites, CommandEncoder, CompareFunction,
    ComputePipeline, FragmentState, MultisampleState, PipelineCompilationOptions, PipelineLayout,
    PipelineLayoutDescriptor, PrimitiveState, RenderPass, RenderPipeline, RenderPipelineDescriptor,
    ShaderModule, VertexAttribute, VertexBufferLayout, VertexFormat, VertexState, VertexStepMode,
};

use super::casters::Casters;
use super::grass::Grass;
use super::ground::{self, Ground, bind};
use super::ground_pipelines::{Parts, SceneParts};
use super::in_sight::InSight;
use super::layouts::{Layouts, STAGE_GROUP, depth_state};
use super::patch_heights;
use super::picking;
use super::plants::Plants;
use super::reprojection::{LightBefore, ReprojectionLayouts, ReprojectionPipelines};
use super::targets::{LIGHT, Targets};
use super::terrain::{PATCH_BYTES, RIM_BYTES, SIDE_BYTES, Terrain};
use super::timing::{Timer, Timestamp};
use crate::gpu::Gpu;
use crate::gpu::context::Context;

/// The passes' own shaders, each after those that it calls.
const SHADERS: [&str; 15] = [
    include_str!("frame.wgsl"),
    include_str!("shadows.wgsl"),
    include_str!("thinning.wgsl"),
    include_str!("canopy.wgsl"),
    include_str!("lawn.wgsl"),
    include_str!("detail.wgsl"),
    include_str!("water.wgsl"),
    include_str!("patch_heights.wgsl"),
    include_str!("terrain.wgsl"),
    include_str!("ground.wgsl"),
    include_str!("reprojection.wgsl"),
    include_str!("casters.wgsl"),
    include_str!("backdrop.wgsl"),
    include_str!("clouds_before.wgsl"),
    include_str!("pick.wgsl"),
];

/// A patch, the slot of its heights, and for sides its edge.
const ATTRIBUTES: [VertexAttribute; 3] = [
    VertexAttribute { format: VertexFormat::Float32x4, offset: 0, shader_location: 0 },
    VertexAttribute { format: VertexFormat::Uint32, offset: 16, shader_location: 1 },
    VertexAttribute { format: VertexFormat::Uint32, offset: PATCH_BYTES, shader_location: 2 },
];

/// The ends of a wall, and its normals there.
const RIM_ATTRIBUTES: [VertexAttribute; 2] = [
    VertexAttribute { format: VertexFormat::Float32x4, offset: 0, shader_location: 0 },
    VertexAttribute { format: VertexFormat::Float32x4, offset: 16, shader_location: 1 },
];

/// The pipelines of a picture's light.
#[derive(Debug)]
pub(super) struct Passes {
    ground: Ground,
    sides: RenderPipeline,
    rims: RenderPipeline,
    /// Of the groups of depths.
    pub(super) depths: [BindGroupLayout; 3],
    pub(super) casters: Casters,
    /// What takes light from the picture before; `None` where pixels have several samples.
    pub(super) reprojection: Option<ReprojectionPipelines>,
    module: ShaderModule,
    picks: (PipelineLayout, BindGroupLayout),
    /// What works out the heights of patches.
    pub(super) heights: ComputePipeline,
    samples: u32,
    /// Whether grass stands on the ground.
    pub(super) has_lawn: bool,
}

/// What a picture is drawn of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawing<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) grass: Option<&'a Grass>,
    pub(super) plants: Option<&'a Plants>,
    /// Whether what lies behind the landscape is left out.
    pub(super) bare: bool,
    /// Whether nothing throws shadows.
    pub(super) casts_nothing: bool,
    pub(super) in_sight: InSight,
    pub(super) before: LightBefore<'a>,
    pub(super) timer: Option<&'a Timer>,
}

/// What pipelines have in common.
struct Maker<'a> {
    context: &'a Context,
    module: ShaderModule,
    /// Of what is drawn by heights of patches, and of what works those out.
    layout: PipelineLayout,
    filling: PipelineLayout,
    with_depths: [PipelineLayout; 3],
    casters: PipelineLayout,
    picks: (PipelineLayout, BindGroupLayout),
    /// Of what takes light from the picture before.
    reprojection: ([PipelineLayout; 2], ReprojectionLayouts),
    samples: u32,
    has: SceneParts,
    has_lawn: bool,
}

/// What one pipeline is.
struct Pipeline<'a> {
    name: &'a str,
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    depth: (bool, CompareFunction),
}

impl Passes {
    pub(super) fn new(
        gpu: &Gpu,
        scene: &LitScene,
        layouts: Layouts<'_>,
        (samples, has_lawn): (u32, bool),
    ) -> Result<Self, Error> {
        let text = scene.shader(STAGE_GROUP) + "\n" + &ground::declaration(samples);
        let text = SHADERS.iter().fold(text, |text, shader| text + "\n" + shader);
        gpu.context.attempt_to_compile("making the pipelines of a picture", || {
            let device = &gpu.context.device;
            let Layouts { frame, maps, cascade, heights } = layouts;
            let drawing = Some(&heights.drawing);
            let whole = |groups: &[Option<&BindGroupLayout>]| {
                device.create_pipeline_layout(&PipelineLayoutDescriptor {
                    label: Some("picture"),
                    bind_group_layouts: groups,
                    immediate_size: 0,
                })
            };
            let depths = ground::depths_layouts(gpu, samples);
            let picks = picking::layout(gpu, samples);
            let before = ReprojectionLayouts::new(gpu);
            let maker = Maker {
                context: &gpu.context,
                module: gpu.context.known.module(&gpu.context.device, "picture", text),
                layout: whole(&[Some(&frame.layout), Some(&maps.layout), None, drawing]),
                filling: whole(&[Some(&frame.caster_layout), Some(&maps.layout), Some(&heights.filling)]),
                with_depths: depths
                    .each_ref()
                    .map(|depths| whole(&[Some(&frame.layout), Some(&maps.layout), Some(depths)])),
                casters: whole(&[Some(&frame.caster_layout), Some(&maps.layout), Some(cascade), drawing]),
                picks: (whole(&[Some(&frame.layout), Some(&maps.layout), Some(&picks)]), picks),
                reprojection: (
                    [
                        whole(&[Some(&frame.layout), None, Some(&before.ground)]),
                        whole(&[Some(&frame.layout), Some(&maps.layout), Some(&before.clouds)]),
                    ],
                    before,
                ),
                samples,
                has: SceneParts::of(scene),
                has_lawn,
            };
            Self::of(&maker, depths)
        })
    }

    fn of(maker: &Maker<'_>, depths: [BindGroupLayout; 3]) -> Result<Self, Error> {
        let instances = |bytes, attributes| VertexBufferLayout {
            array_stride: bytes,
            step_mode: VertexStepMode::Instance,
            attributes,
        };
        let patches = [Some(instances(PATCH_BYTES, &ATTRIBUTES[..2]))];
        let sides = [Some(instances(SIDE_BYTES, &ATTRIBUTES[..]))];
        let rims = [Some(instances(RIM_BYTES, &RIM_ATTRIBUTES[..]))];
        let solid = |name, buffers| {
            let depth = (true, CompareFunction::Greater);
            maker.light(&Pipeline { name, buffers, depth })
        };
        let caster = |name, buffers| {
            let depth = (true, CompareFunction::Less);
            maker.caster(&Pipeline { name, buffers, depth })
        };
        let parts = Parts {
            context: maker.context,
            module: &maker.module,
            layouts: [&maker.with_depths[0], &maker.layout, &maker.with_depths[1], &maker.with_depths[2]],
            patches: &patches,
            samples: maker.samples,
            has: maker.has,
            has_lawn: maker.has_lawn,
        };
        let ([ground, clouds], before) = &maker.reprojection;
        Ok(Self {
            ground: Ground::new(parts)?,
            depths,
            reprojection: (maker.samples == 1).then(|| ReprojectionPipelines {
                ground: parts.reprojected(ground),
                clouds: maker.has.clouds.then(|| parts.clouds_before(clouds)),
                layouts: before.clone(),
            }),
            sides: solid("side", &sides),
            rims: solid("rim", &rims),
            casters: Casters {
                ground: caster("ground", &patches),
                beyond: maker.has.horizon.then(|| caster("beyond", &patches)),
                sides: caster("side", &sides),
                rims: caster("rim", &rims),
            },
            module: maker.module.clone(),
            heights: patch_heights::pipeline(
                maker.context,
                (&maker.module, &maker.filling),
                maker.has.horizon,
            ),
            picks: maker.picks.clone(),
            samples: maker.samples,
            has_lawn: maker.has_lawn,
        })
    }

    /// The pipeline that says what is seen at places of a picture, and what it is bound to.
    pub(super) fn picks(&self, gpu: &Gpu) -> Result<(ComputePipeline, BindGroupLayout), Error> {
        let (layout, bound) = &self.picks;
        gpu.context.attempt_to_compile("making the pipeline of picks", || {
            Ok((picking::pipeline(&gpu.context, (&self.module, layout), self.samples), bound.clone()))
        })
    }

    /// Draws all light of a picture; all passes but those of shadows and film. What is asked of it is encoded by `pick`
    /// when the ground and its sides are drawn.
    pub(super) fn draw(
        &self,
        encoder: &mut CommandEncoder,
        (targets, depths): (&Targets, &[BindGroup; 3]),
        groups: [&BindGroup; 2],
        drawing: Drawing<'_>,
        pick: Option<impl FnOnce(&mut CommandEncoder)>,
    ) {
        let timer = drawing.timer;
        let mut pass = targets.depth_pass(encoder);
        bind(&mut pass, groups);
        self.ground.draw_depths(&mut pass, drawing.terrain);
        drop(pass);
        targets.keep_ground(encoder);
        let mut pass = targets.walls_pass(encoder);
        bind(&mut pass, groups);
        self.draw_walls(&mut pass, drawing.terrain);
        if let Some(timer) = timer {
            timer.note(&mut pass, Timestamp::Depths);
        }
        drop(pass);
        if let Some(pick) = pick {
            pick(encoder);
        }
        if drawing.grass.is_some() || drawing.plants.is_some() || timer.is_some() {
            let mut pass = targets.growth_pass(encoder, timer);
            bind(&mut pass, groups);
            draw_what_grows(&mut pass, drawing);
        }
        let takes = drawing.before.take(encoder, (targets, groups[0]), self.reprojection.as_ref());
        // What is hidden by now is not lit.
        self.ground.draw_kinds(encoder, (targets, depths, takes), groups, drawing.in_sight);
        let mut pass = targets.ground_pass(encoder);
        bind(&mut pass, groups);
        self.ground.draw_light(&mut pass, &depths[0], drawing.in_sight);
        if let Some(timer) = timer {
            timer.note(&mut pass, Timestamp::Ground);
        }
        drop(pass);
        drawing.before.keep(encoder, targets);
        if !drawing.bare {
            self.draw_clouds(encoder, (targets, depths), groups, &drawing);
        }
        let mut pass = targets.backdrop_pass(encoder);
        bind(&mut pass, groups);
        if !drawing.bare {
            self.ground.draw_backdrop(&mut pass, (depths, targets.light.size()), drawing.in_sight);
        }
        if let Some(timer) = timer {
            timer.note(&mut pass, Timestamp::Behind);
        }
    }

    /// Draws the light of clouds, where they are in sight, and keeps it for the next picture of a window.
    fn draw_clouds(
        &self,
        encoder: &mut CommandEncoder,
        (targets, depths): (&Targets, &[BindGroup; 3]),
        groups: [&BindGroup; 2],
        &Drawing { in_sight, before, .. }: &Drawing<'_>,
    ) {
        let is_seen = self.ground.has_clouds(in_sight);
        if is_seen || before.is_kept() {
            let mut pass = targets.cloud_pass(encoder);
            bind(&mut pass, groups);
            let size = targets.clouds.size();
            in_sight.rows_of_clouds(size[1]).limit(&mut pass, size);
            // Of clouds around the eye each has another distance.
            let takes = before.clouds(self.reprojection.as_ref()).filter(|_| !in_sight.is_over_clouds);
            match takes {
                _ if !is_seen => {}
                Some((pipeline, group)) => ground::draw_whole(&mut pass, pipeline, group),
                None => self.ground.draw_clouds(&mut pass, &depths[0]),
            }
            drop(pass);
            before.keep_clouds(encoder, targets);
        }
    }

    /// Draws the cut sides.
    fn draw_walls(&self, pass: &mut RenderPass<'_>, terrain: &Terrain) {
        pass.set_pipeline(&self.sides);
        terrain.draw_sides(pass, 0);
        pass.set_pipeline(&self.rims);
        terrain.draw_rims(pass);
    }
}

/// Draws grass and plants.
fn draw_what_grows(pass: &mut RenderPass<'_>, drawing: Drawing<'_>) {
    if let Some(grass) = drawing.grass {
        grass.draw(pass);
    }
    if let Some(timer) = drawing.timer {
        timer.note(pass, Timestamp::Grass);
    }
    if let Some(plants) = drawing.plants {
        plants.draw(pass);
    }
}

impl Maker<'_> {
    /// The pipeline of the entry points `NAME_vertex` and `NAME_fragment`.
    fn light(&self, pipeline: &Pipeline<'_>) -> RenderPipeline {
        let target = ColorTargetState { format: LIGHT, blend: None, write_mask: ColorWrites::ALL };
        let names = ["vertex", "fragment"].map(|part| format!("{}_{part}", pipeline.name));
        let holes = [("HOLES", f64::from(self.has.holes))];
        let compilation_options =
            PipelineCompilationOptions { constants: &holes, ..PipelineCompilationOptions::default() };
        let fragment = FragmentState {
            module: &self.module,
            entry_point: Some(&names[1]),
            compilation_options,
            targets: &[Some(target)],
        };
        self.pipeline(pipeline, &names[0], (&self.layout, self.samples), Some(fragment))
    }

    /// The pipeline of the entry point `NAME_caster`, with `caster_fragment` where there are holes.
    fn caster(&self, pipeline: &Pipeline<'_>) -> RenderPipeline {
        let fragment = FragmentState {
            module: &self.module,
            entry_point: Some("caster_fragment"),
            compilation_options: PipelineCompilationOptions::default(),
            targets: &[],
        };
        let name = format!("{}_caster", pipeline.name);
        self.pipeline(pipeline, &name, (&self.casters, 1), self.has.holes.then_some(fragment))
    }

    fn pipeline(
        &self,
        pipeline: &Pipeline<'_>,
        vertex: &str,
        (layout, samples): (&PipelineLayout, u32),
        fragment: Option<FragmentState<'_>>,
    ) -> RenderPipeline {
        let (depth_write, compare) = pipeline.depth;
        let make = || {
            self.context.device.create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(pipeline.name),
                layout: Some(layout),
                vertex: VertexState {
                    module: &self.module,
                    entry_point: Some(vertex),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: pipeline.buffers,
                },
                primitive: PrimitiveState::default(),
                depth_stencil: Some(depth_state(depth_write, compare)),
                multisample: MultisampleState { count: samples, ..MultisampleState::default() },
                fragment,
                multiview_mask: None,
                cache: None,
            })
        };
        let key = format!("{vertex} {samples} {}", self.has.holes);
        self.context.known.drawing((self.module.clone(), key), make)
    }
}
