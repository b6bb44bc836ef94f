//! What is seen at places of a picture, asked of the device with one picture and answered some pictures later: `pick.wgsl`.

use weald::Error;
use weald::picture::LitScene;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, BufferUsages, CommandEncoder,
    ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions,
    PipelineLayout, ShaderModule, ShaderStages,
};

use super::ground::depths_entry;
use super::returning::Returning;
use super::targets::Targets;
use super::upload::Upload;
use crate::gpu::Gpu;
use crate::gpu::context::Context;
use crate::memory::Store;

/// Most places that are asked with one picture; more wait for the next.
const MAX_PICKS: usize = 1024;

/// Places of a workgroup, as the shader has it.
const GROUP: u32 = 64;

/// Bytes of a place and of an answer.
const ASKED: u64 = 8;
const ANSWERED: u64 = 16;

/// Pictures whose answers may be on their way.
const IN_FLIGHT: usize = 3;

/// Outside of every picture.
const NOWHERE: [f32; 2] = [-1.0; 2];

/// What is seen at a place of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// The place that was asked, in pixels rightward and downward from the upper left corner.
    pub at: [f32; 2],
    /// The ground there; `None` where sky, the plain around the landscape, or a cut side is seen.
    pub ground: Option<PickedGround>,
}

/// A point of the ground, or of the water on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedGround {
    /// As a [`Camera`](weald::picture::Camera) counts.
    pub point: [f32; 3],
    /// Metres eastward and southward of the landscape's north-western corner.
    pub place: [f64; 2],
    /// Elevation in metres, of the water where there is some.
    pub elevation: f64,
    /// Column and row of the drawn ground, which are those of the landscape up to 4096 a side.
    pub cell: [usize; 2],
}

/// How points of a picture become places of the landscape.
#[derive(Clone, Copy, Debug)]
pub(super) struct LandScale {
    cells: [usize; 2],
    spacing: [f32; 2],
    low: f32,
    exaggeration: f32,
}

impl LandScale {
    pub(super) fn of(scene: &LitScene) -> Self {
        let follow = scene.follow();
        let (low, exaggeration) = (follow.low, follow.exaggeration);
        Self { cells: scene.cells(), spacing: scene.spacing(), low, exaggeration }
    }

    fn ground(&self, point: [f32; 3]) -> PickedGround {
        let place = [f64::from(point[0]), -f64::from(point[1])];
        let cell = [0, 1].map(|axis| {
            let cell = (place[axis] / f64::from(self.spacing[axis])).max(0.0) as usize;
            cell.min(self.cells[axis].saturating_sub(1))
        });
        let elevation = f64::from(self.low) + f64::from(point[2] / self.exaggeration);
        PickedGround { point, place, elevation, cell }
    }
}

/// The layout of what is asked and answered, beside the depths of pictures of so many samples.
pub(super) fn layout(gpu: &Gpu, samples: u32) -> BindGroupLayout {
    let storage = |binding, read_only| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer {
            ty: BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let depths = depths_entry(samples, ShaderStages::COMPUTE);
    let entries = [depths, storage(2, true), storage(3, false)];
    let description = BindGroupLayoutDescriptor { label: Some("picks"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

/// Places that are asked of one view, and answers on their way.
#[derive(Debug)]
pub(super) struct Picking {
    pipeline: ComputePipeline,
    layout: BindGroupLayout,
    asked: Store,
    answered: Store,
    group: BindGroup,
    coming: Vec<Answer>,
    waiting: Vec<[f32; 2]>,
}

/// Places that were asked with one picture, and their answers.
#[derive(Debug)]
struct Answer {
    asked: Vec<[f32; 2]>,
    points: Returning,
}

impl Picking {
    pub(super) fn new(
        gpu: &Gpu,
        (pipeline, layout): (ComputePipeline, BindGroupLayout),
        targets: &Targets,
    ) -> Result<Self, Error> {
        let room = |what, bytes: u64, usage| Store::new(gpu, what, bytes * MAX_PICKS as u64, usage);
        let asked = room("picked places", ASKED, BufferUsages::STORAGE | BufferUsages::COPY_DST)?;
        let answered = room("picked points", ANSWERED, BufferUsages::STORAGE | BufferUsages::COPY_SRC)?;
        let answer = |_| {
            let points = Returning::new(gpu, "picked points", ANSWERED * MAX_PICKS as u64)?;
            Ok(Answer { asked: Vec::new(), points })
        };
        let coming = (0..IN_FLIGHT).map(answer).collect::<Result<_, Error>>()?;
        let group = bind(gpu, &layout, targets, [&asked, &answered]);
        Ok(Self { pipeline, layout, asked, answered, group, coming, waiting: Vec::new() })
    }

    /// Asks of other canvases from now on.
    pub(super) fn aim_at(&mut self, gpu: &Gpu, targets: &Targets) {
        self.group = bind(gpu, &self.layout, targets, [&self.asked, &self.answered]);
    }

    /// Asks a place with the next picture.
    pub(super) fn ask(&mut self, at: [f32; 2]) {
        self.waiting.push(at);
    }

    /// Whether anything can be asked with the next picture.
    pub(super) fn is_due(&self) -> bool {
        !self.waiting.is_empty() && self.free().is_some()
    }

    fn free(&self) -> Option<usize> {
        self.coming.iter().position(|answer| answer.points.is_free())
    }

    /// Encodes what is asked, when the ground and its sides are drawn.
    pub(super) fn encode(&mut self, gpu: &Gpu, encoder: &mut CommandEncoder, groups: [&BindGroup; 2]) {
        let Some(answer) = self.free() else { return };
        let count = self.waiting.len().min(MAX_PICKS);
        let places: Vec<_> = self.waiting.drain(..count).collect();
        let mut all = places.clone();
        all.resize(count.next_multiple_of(GROUP as usize), NOWHERE);
        Upload { gpu, encoder }.write(&self.asked, bytemuck::cast_slice(&all));
        let description = ComputePassDescriptor { label: Some("picks"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&description);
        pass.set_pipeline(&self.pipeline);
        for (at, group) in (0..).zip([groups[0], groups[1], &self.group]) {
            pass.set_bind_group(at, group, &[]);
        }
        pass.dispatch_workgroups((count as u32).div_ceil(GROUP), 1, 1);
        drop(pass);
        let answer = &mut self.coming[answer];
        answer.points.copy(encoder, &self.answered, ANSWERED * count as u64);
        answer.asked = places;
    }

    /// What was encoded was submitted: its answers may come.
    pub(super) fn submitted(&mut self) {
        self.coming.iter_mut().for_each(|answer| answer.points.submitted());
    }

    /// What has come by now, picture by picture, in the order of the places.
    pub(super) fn answers(&mut self, scale: &LandScale) -> Result<Vec<Pick>, Error> {
        let mut picks = Vec::new();
        for answer in &mut self.coming {
            let Some(points) = answer.points.take::<[f32; 4]>()? else { continue };
            let of_ground = |[x, y, z, kind]: [f32; 4]| (kind == 1.0).then(|| scale.ground([x, y, z]));
            let pick = |(&at, point)| Pick { at, ground: of_ground(point) };
            picks.extend(answer.asked.iter().zip(points).map(pick));
        }
        Ok(picks)
    }
}

fn bind(gpu: &Gpu, layout: &BindGroupLayout, targets: &Targets, stores: [&Store; 2]) -> BindGroup {
    let depths = BindingResource::TextureView(&targets.depth.view);
    let entries = [
        BindGroupEntry { binding: 1, resource: depths },
        BindGroupEntry { binding: 2, resource: stores[0].buffer.as_entire_binding() },
        BindGroupEntry { binding: 3, resource: stores[1].buffer.as_entire_binding() },
    ];
    let description = BindGroupDescriptor { label: Some("picks"), layout, entries: &entries };
    gpu.context.device.create_bind_group(&description)
}

/// The pipeline that says what is seen at places of a picture of so many samples, by a module of all shaders of a picture.
pub(super) fn pipeline(
    context: &Context,
    (module, layout): (&ShaderModule, &PipelineLayout),
    samples: u32,
) -> ComputePipeline {
    let constants = [("SAMPLED", f64::from(samples > 1))];
    let make = || {
        context.device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("pick"),
            layout: Some(layout),
            module,
            entry_point: Some("pick"),
            compilation_options: PipelineCompilationOptions {
                constants: &constants,
                ..PipelineCompilationOptions::default()
            },
            cache: None,
        })
    };
    context.known.computing((module.clone(), format!("pick {samples}")), make)
}
