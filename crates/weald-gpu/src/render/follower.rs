//! What makes surfaces of the ground and water of a running simulation, and bounds of them.

use weald::Error;
use weald::picture::LitScene;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, BufferUsages, CommandEncoder,
    ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions,
};

use super::maps::Maps;
use super::returning::Returning;
use crate::gpu::Gpu;
use crate::live::Live;
use crate::memory::Store;
use crate::transfer::uniform;

/// Control points along the side of a workgroup, and beyond each border, as the shader has them.
const GROUP: u32 = 16;
const RIM: u32 = 2;

/// Squares along the side of a workgroup that finds their bounds, of so many control points a side.
const BOUNDS_GROUP: u32 = 8;
const SMALLEST: u32 = 4;

/// What makes surfaces and bounds.
#[derive(Debug)]
pub(super) struct Follower {
    surfaces: ComputePipeline,
    bounds: ComputePipeline,
    numbers: Store,
    found: Store,
    found_group: BindGroup,
    returning: Returning,
}

impl Follower {
    pub(super) fn new(gpu: &Gpu, scene: &LitScene, maps: &Maps, squares: usize) -> Result<Self, Error> {
        let numbers = uniform(gpu, "what is followed", &scene.follow())?;
        let bytes = 8 * squares as u64;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let found = Store::new(gpu, "bounds of the ground", bytes, usage)?;
        let returning = Returning::new(gpu, "bounds of the ground", bytes)?;
        gpu.context.attempt("making the pipelines that follow a simulation", || {
            let surfaces = pipeline(gpu, LitScene::FOLLOW, "follow_ground");
            let bounds = pipeline(gpu, include_str!("bounds.wgsl"), "bound");
            let resources =
                [BindingResource::TextureView(maps.view("top")), found.buffer.as_entire_binding()];
            let found_group = bind(gpu, &bounds, resources);
            Ok(Self { surfaces, bounds, numbers, found, found_group, returning })
        })
    }

    /// Encodes that the surfaces become those of ground and water as they are now, and that their bounds are told, unless
    /// those of before are on their way.
    pub(super) fn encode(&mut self, gpu: &Gpu, encoder: &mut CommandEncoder, maps: &Maps, live: &Live) {
        let [ground, depth] = live.stores();
        let map = |name| BindingResource::TextureView(maps.view(name));
        let resources = [
            self.numbers.buffer.as_entire_binding(),
            ground.buffer.as_entire_binding(),
            depth.buffer.as_entire_binding(),
            map("land"),
            map("top"),
            map("bed"),
            map("level"),
        ];
        let group = bind(gpu, &self.surfaces, resources);
        let points = [live.size().columns, live.size().rows].map(|cells| cells as u32 + 2 * RIM);
        run(encoder, &self.surfaces, &group, points.map(|points| points.div_ceil(GROUP)));
        if self.returning.is_free() {
            let squares = points.map(|points| points.div_ceil(SMALLEST));
            run(encoder, &self.bounds, &self.found_group, squares.map(|side| side.div_ceil(BOUNDS_GROUP)));
            self.returning.copy(encoder, &self.found, self.found.buffer.size());
        }
    }

    /// What was encoded was submitted.
    pub(super) fn submitted(&mut self) {
        self.returning.submitted();
    }

    /// The bounds of all squares, as they were lately; `None` while none have come.
    pub(super) fn bounds(&mut self) -> Result<Option<Vec<[f32; 2]>>, Error> {
        self.returning.take()
    }
}

fn run(encoder: &mut CommandEncoder, pipeline: &ComputePipeline, group: &BindGroup, groups: [u32; 2]) {
    let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.dispatch_workgroups(groups[0], groups[1], 1);
}

fn bind<const N: usize>(
    gpu: &Gpu,
    pipeline: &ComputePipeline,
    resources: [BindingResource<'_>; N],
) -> BindGroup {
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
    let layout = &pipeline.get_bind_group_layout(0);
    gpu.context.device.create_bind_group(&BindGroupDescriptor {
        label: Some("follow"),
        layout,
        entries: &entries,
    })
}

fn pipeline(gpu: &Gpu, text: &str, name: &str) -> ComputePipeline {
    let (device, known) = (&gpu.context.device, &gpu.context.known);
    let module = known.module(device, "follow", text.to_owned());
    let make = || {
        device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(name),
            layout: None,
            module: &module,
            entry_point: Some(name),
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        })
    };
    known.computing((module.clone(), name.to_owned()), make)
}
