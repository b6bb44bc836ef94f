//! Grass on a device: the sets around the camera, culled and thinned there, and drawn blade by blade.
//!
//! The processor makes the instances of 16 bytes of the squares around the camera (`weald::grow::grass`), as often as it
//! comes into another square, and of a picture that is drawn once those in its sight (`sowing.rs`); all else happens on the device. Three passes (`cull.wgsl`) put those in sight into one of
//! three lists by distance, of which each is an indirect draw of blades with fewer vertices. Sets that are close together lie
//! side by side, so that one look leaves out those of a run that no camera there sees (`runs.rs`). The farther, the fewer sets
//! stand, and the broader are their blades; a set sinks into the ground over a stretch of the way, so that none vanishes
//! at once (`meadow.wgsl`, of which `weald::grow::grass::choice` is the definition). What a blade is, is worked out once
//! (`light_sets.wgsl`), and read by its vertices (`lit_sets.wgsl`).

use weald::grow::Vegetation;
use weald::grow::grass::device::FUNCTIONS;
use weald::grow::grass::{BLADES, choice};
use weald::grow::wind;
use weald::picture::LitScene;
use weald::{Error, Landscape};
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType,
    BufferBindingType, CommandEncoder, ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor,
    IndexFormat, PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, RenderPass,
    RenderPipeline, ShaderModule, ShaderStages,
};

use super::blades;
use super::grass_layer::{Around, DRAW, GrassLayer, LoadedSets};
use super::layouts::{Layouts, STAGE_GROUP};
use super::records;
use super::timing::Timer;
use crate::gpu::Gpu;

/// Names of the lists' entry points.
const LISTS: [&str; choice::LISTS] = ["near_blade", "middle_blade", "far_blade"];

/// Names of the passes that choose, in order, and whether one workgroup does it all.
const CHOOSING: [(&str, bool); 3] = [("mark", false), ("sum", true), ("gather", false)];

/// The grass of a landscape.
#[derive(Debug)]
pub(super) struct Grass {
    layers: Vec<GrassLayer>,
    choosing: Vec<ComputePipeline>,
    lighting: ComputePipeline,
    draws: Vec<RenderPipeline>,
    layouts: [BindGroupLayout; 3],
}

impl Grass {
    /// The pipelines of grass; `None` where a landscape has none.
    pub(super) fn new(
        gpu: &Gpu,
        (scene, landscape): (&LitScene, &Landscape),
        layouts: Layouts<'_>,
        samples: u32,
    ) -> Result<Option<Self>, Error> {
        let has_holes = scene.has_holes();
        let layers = landscape.all_meadows().map(|(_, meadow)| GrassLayer::new(gpu, &meadow, has_holes));
        let layers = layers.collect::<Result<Vec<_>, _>>()?;
        if layers.is_empty() {
            return Ok(None);
        }
        let device = &gpu.context.device;
        let own = [CHOOSES, LIGHTS, DRAWS].map(|own| layout(gpu, own));
        let whole = |frame: &BindGroupLayout, own: &BindGroupLayout| {
            device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label: Some("grass"),
                bind_group_layouts: &[Some(frame), Some(&layouts.maps.layout), Some(own)],
                immediate_size: 0,
            })
        };
        gpu.context.attempt_to_compile("making the pipelines of grass", || {
            let module = module(gpu, scene, include_str!("cull.wgsl"));
            let layout = whole(&layouts.frame.caster_layout, &own[0]);
            let choosing = CHOOSING.map(|(name, _)| {
                let description = ComputePipelineDescriptor {
                    label: Some(name),
                    layout: Some(&layout),
                    module: &module,
                    entry_point: Some(name),
                    compilation_options: PipelineCompilationOptions::default(),
                    cache: None,
                };
                let make = || device.create_compute_pipeline(&description);
                gpu.context.known.computing((module.clone(), name.to_owned()), make)
            });
            let lighting = lighting(gpu, scene, &whole(&layouts.frame.layout, &own[1]));
            let module = self::module(gpu, scene, include_str!("blades.wgsl"));
            let layout = whole(&layouts.frame.layout, &own[2]);
            let draws = LISTS.map(|name| blades::pipeline(&gpu.context, (&module, &layout), name, samples));
            Ok(Some(Self {
                layers,
                choosing: choosing.to_vec(),
                lighting,
                draws: draws.to_vec(),
                layouts: own.clone(),
            }))
        })
    }

    /// Sows what is around a point, or all.
    pub(super) fn prepare(&mut self, gpu: &Gpu, around: &Around<'_>) -> Result<(), Error> {
        self.layers.iter_mut().try_for_each(|layer| layer.prepare(gpu, around, &self.layouts))
    }

    /// Metres up to which all sets stand, as the densest grass has it, where blades reach so many times as far: one number for all, which the
    /// ground has as well.
    pub(super) fn whole(&self, reach: f32) -> f32 {
        choice::whole(self.layers.iter().map(GrassLayer::densest).fold(0.0, f64::max), reach)
    }

    /// The sets that are there now.
    pub(super) fn loaded(&self) -> impl Iterator<Item = &LoadedSets> {
        self.layers.iter().filter_map(GrassLayer::loaded)
    }

    /// Encodes the choice of what is drawn.
    pub(super) fn choose(
        &self,
        encoder: &mut CommandEncoder,
        groups: [&BindGroup; 2],
        timer: Option<&Timer>,
    ) {
        let timestamp_writes = timer.map(Timer::around_choice);
        let mut pass = encoder
            .begin_compute_pass(&ComputePassDescriptor { label: Some("choice of grass"), timestamp_writes });
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for loaded in self.loaded() {
            pass.set_bind_group(2, &loaded.cull, &[]);
            for ((_, alone), pipeline) in CHOOSING.iter().zip(&self.choosing) {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(if *alone { 1 } else { loaded.groups() }, 1, 1);
            }
        }
    }

    /// Encodes what the blades of chosen sets are where they are looked at, when shadows are drawn.
    pub(super) fn light(&self, encoder: &mut CommandEncoder, groups: [&BindGroup; 2]) {
        let description = ComputePassDescriptor { label: Some("light of grass"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&description);
        pass.set_pipeline(&self.lighting);
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for loaded in self.loaded() {
            pass.set_bind_group(2, &loaded.light, &[]);
            pass.dispatch_workgroups_indirect(&loaded.draws.buffer, DRAW * LISTS.len() as u64);
        }
    }

    /// Draws all blades.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>) {
        for loaded in self.loaded() {
            pass.set_bind_group(2, &loaded.draw, &[]);
            pass.set_index_buffer(loaded.corners.buffer.slice(..), IndexFormat::Uint16);
            for (list, pipeline) in (0..).zip(&self.draws) {
                pass.set_pipeline(pipeline);
                for (slot, list) in [(0, list), (1, list + 1)] {
                    pass.set_vertex_buffer(slot, loaded.starts.buffer.slice(loaded.start_of(list)..));
                }
                pass.draw_indexed_indirect(&loaded.draws.buffer, DRAW * list);
            }
        }
    }
}

/// The shader of a part of grass.
fn module(gpu: &Gpu, scene: &LitScene, own: &str) -> ShaderModule {
    let parts = [
        include_str!("frame.wgsl"),
        include_str!("records.wgsl"),
        include_str!("shadows.wgsl"),
        include_str!("thinning.wgsl"),
        include_str!("canopy.wgsl"),
        include_str!("thin.wgsl"),
        wind::FUNCTIONS,
        FUNCTIONS,
        include_str!("meadow.wgsl"),
        include_str!("lit_sets.wgsl"),
        own,
    ];
    let text = parts.iter().fold(scene.shader_of_light(STAGE_GROUP), |text, part| text + "\n" + part);
    gpu.context.known.module(&gpu.context.device, "grass", text)
}

/// What lights the sets that were chosen.
fn lighting(gpu: &Gpu, scene: &LitScene, layout: &PipelineLayout) -> ComputePipeline {
    let module = module(gpu, scene, include_str!("light_sets.wgsl"));
    let description = ComputePipelineDescriptor {
        label: Some("light_sets"),
        layout: Some(layout),
        module: &module,
        entry_point: Some("light_sets"),
        compilation_options: PipelineCompilationOptions::default(),
        cache: None,
    };
    let make = || gpu.context.device.create_compute_pipeline(&description);
    gpu.context.known.computing((module.clone(), "light_sets".to_owned()), make)
}

/// The stage of a pass, and its bindings after the species and what is shown: the sets, those that are kept, where their lists
/// start, and the draws, marks and runs; or the lit sets and their blades behind the lists, or alone.
type Own = (ShaderStages, &'static [BindingType]);
const CHOOSES: Own = (ShaderStages::COMPUTE, &[READ, CHANGED, CHANGED, CHANGED, CHANGED, READ]);
const LIGHTS: Own = (ShaderStages::COMPUTE, &[READ, READ, READ, records::WRITTEN, records::WRITTEN]);
const DRAWS: Own = (ShaderStages::VERTEX, &[records::READ, records::READ]);

const UNIFORM: BindingType = buffer(BufferBindingType::Uniform);
const READ: BindingType = buffer(BufferBindingType::Storage { read_only: true });
const CHANGED: BindingType = buffer(BufferBindingType::Storage { read_only: false });

const fn buffer(ty: BufferBindingType) -> BindingType {
    BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// The bindings of a pass.
fn layout(gpu: &Gpu, (visibility, own): Own) -> BindGroupLayout {
    let kinds = [UNIFORM; 2].into_iter().chain(own.iter().copied());
    let entries = (0..).zip(kinds);
    let entries: Vec<_> =
        entries.map(|(binding, ty)| BindGroupLayoutEntry { binding, visibility, ty, count: None }).collect();
    let description = BindGroupLayoutDescriptor { label: Some("grass"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

const _: () = assert!(BLADES == 6, "as the lists count instances");
