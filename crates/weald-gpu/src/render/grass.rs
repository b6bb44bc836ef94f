//! Grass on a device: the sets around the camera, culled and thinned there, and drawn blade by blade.
//!
//! The processor makes the instances of 16 bytes of the squares around the camera (`weald::grow::grass`), as often as it
//! comes into another square; all else happens on the device. A pass over all sets (`cull.wgsl`) appends those in sight to
//! one of three lists by distance, of which each is an indirect draw of blades with fewer vertices. The farther, the
//! fewer sets stand, and the broader are their blades; a set sinks into the ground over a stretch of the way, so that none
//! vanishes at once (`meadow.wgsl`).

use std::sync::Arc;

use weald::engine::uniform::Uniform;
use weald::grow::grass::device::FUNCTIONS;
use weald::grow::grass::{Area, BLADES, Grasses, Meadow};
use weald::grow::wind;
use weald::picture::{Camera, Stage};
use weald::{Error, Landscape};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingType, BufferBindingType, BufferUsages, CommandEncoder,
    ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions,
    PipelineLayoutDescriptor, RenderPass, RenderPipeline, ShaderModuleDescriptor, ShaderSource, ShaderStages,
};

use super::passes::{Layouts, STAGE_GROUP, strips};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Distance in metres to which grass is drawn, as `meadow.wgsl` has it.
const FARTHEST: f64 = 96.0;

/// Side of the squares in metres, at the change of which sets are made anew.
const SQUARE: f64 = 16.0;

/// Most sets at once: 128 MiB of instances.
const MOST_SETS: f64 = (1_u32 << 23) as f64;

/// Names of the lists' entry points, and the rows of their blades, as `blades.wgsl` has them.
const LISTS: [(&str, u32); 3] = [("near_blade", 9), ("middle_blade", 5), ("far_blade", 3)];

/// Bytes of what an indirect draw wants.
const DRAW: u64 = 16;

/// The grass of a landscape.
#[derive(Debug)]
pub(super) struct Grass {
    meadows: Vec<Lawn>,
    cull: ComputePipeline,
    cull_layout: BindGroupLayout,
    draws: Vec<RenderPipeline>,
    draw_layout: BindGroupLayout,
}

/// One grass of a landscape.
#[derive(Debug)]
struct Lawn {
    meadow: Arc<Meadow>,
    grasses: Store,
    sown: Option<Sown>,
    square: Option<[i64; 2]>,
}

/// The sets around a camera.
#[derive(Debug)]
struct Sown {
    count: u32,
    draws: Store,
    cull: BindGroup,
    draw: BindGroup,
    _sets: Store,
    _kept: Store,
}

impl Grass {
    /// The pipelines of grass; `None` where a landscape has none.
    pub(super) fn new(
        gpu: &Gpu,
        (stage, landscape): (&Stage, &Landscape),
        layouts: Layouts<'_>,
        samples: u32,
    ) -> Result<Option<Self>, Error> {
        let meadows = landscape.all_meadows().map(|(_, meadow)| Lawn::new(gpu, meadow));
        let meadows = meadows.collect::<Result<Vec<_>, _>>()?;
        if meadows.is_empty() {
            return Ok(None);
        }
        let device = &gpu.context.device;
        let module = |own: &[&str]| {
            let shared =
                [include_str!("frame.wgsl"), include_str!("shadows.wgsl"), wind::FUNCTIONS, FUNCTIONS];
            let text = shared.iter().chain(&[include_str!("meadow.wgsl")]).chain(own);
            let text = text.fold(stage.shader_of_light(STAGE_GROUP), |text, part| text + "\n" + part);
            let source = ShaderSource::Wgsl(text.into());
            device.create_shader_module(ShaderModuleDescriptor { label: Some("grass"), source })
        };
        let cull_layout = layout(gpu, ShaderStages::COMPUTE, &[true, false, false]);
        let draw_layout = layout(gpu, ShaderStages::VERTEX, &[true, true]);
        let whole = |frame: &BindGroupLayout, own: &BindGroupLayout| {
            device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label: Some("grass"),
                bind_group_layouts: &[Some(frame), Some(&layouts.maps.layout), Some(own)],
                immediate_size: 0,
            })
        };
        gpu.context.attempt("making the pipelines of grass", || {
            let cull = device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some("cull"),
                layout: Some(&whole(&layouts.frame.caster_layout, &cull_layout)),
                module: &module(&[include_str!("cull.wgsl")]),
                entry_point: Some("cull"),
                compilation_options: PipelineCompilationOptions::default(),
                cache: None,
            });
            let (blades, drawn) =
                (module(&[include_str!("blades.wgsl")]), whole(&layouts.frame.layout, &draw_layout));
            let draws = LISTS.map(|(name, _)| strips(device, (&blades, &drawn), name, samples)).to_vec();
            Ok(Some(Self {
                meadows,
                cull,
                cull_layout: cull_layout.clone(),
                draws,
                draw_layout: draw_layout.clone(),
            }))
        })
    }

    /// Sows what is around a camera.
    pub(super) fn prepare(&mut self, gpu: &Gpu, camera: &Camera) -> Result<(), Error> {
        let place = [f64::from(camera.eye[0]), f64::from(-camera.eye[1])];
        let square = place.map(|at| (at / SQUARE).floor() as i64);
        for lawn in &mut self.meadows {
            if lawn.square != Some(square) {
                lawn.sown = None;
                lawn.sown = lawn.sow(gpu, square, [&self.cull_layout, &self.draw_layout])?;
                lawn.square = Some(square);
            }
            if let Some(sown) = &lawn.sown {
                let empty = LISTS.map(|(_, rows)| [2 * rows, 0, 0, 0]);
                gpu.context.queue.write_buffer(&sown.draws.buffer, 0, bytemuck::cast_slice(&empty));
            }
        }
        Ok(())
    }

    /// Encodes the choice of what is drawn.
    pub(super) fn choose(&self, encoder: &mut CommandEncoder, groups: [&BindGroup; 2]) {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&self.cull);
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for sown in self.meadows.iter().filter_map(|lawn| lawn.sown.as_ref()) {
            pass.set_bind_group(2, &sown.cull, &[]);
            let groups = sown.count.div_ceil(64);
            pass.dispatch_workgroups(groups.min(65_535), groups.div_ceil(65_535), 1);
        }
    }

    /// Draws all blades.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>) {
        for sown in self.meadows.iter().filter_map(|lawn| lawn.sown.as_ref()) {
            pass.set_bind_group(2, &sown.draw, &[]);
            for (list, pipeline) in (0..).zip(&self.draws) {
                pass.set_pipeline(pipeline);
                pass.draw_indirect(&sown.draws.buffer, DRAW * list);
            }
        }
    }
}

impl Lawn {
    fn new(gpu: &Gpu, meadow: &Arc<Meadow>) -> Result<Self, Error> {
        // A struct takes whole vectors of four.
        let mut words = Grasses::new(&meadow.species, meadow.bend).words();
        words.resize(words.len().next_multiple_of(4), 0);
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let grasses = Store::new(gpu, "the species of grass", 4 * words.len() as u64, usage)?;
        gpu.context.queue.write_buffer(&grasses.buffer, 0, bytemuck::cast_slice(&words));
        Ok(Self { meadow: Arc::clone(meadow), grasses, sown: None, square: None })
    }

    /// The sets around a square; `None` where there are none.
    fn sow(
        &self,
        gpu: &Gpu,
        square: [i64; 2],
        [cull_layout, draw_layout]: [&BindGroupLayout; 2],
    ) -> Result<Option<Sown>, Error> {
        let low = square.map(|at| at as f64 * SQUARE - FARTHEST);
        let high = square.map(|at| (at + 1) as f64 * SQUARE + FARTHEST);
        let area = Area { low, high };
        let expected = self.meadow.expected(&area);
        if expected > MOST_SETS {
            return Err(Error::Limit(format!(
                "{expected:.0} sets of grass within {FARTHEST} m of the camera: at most {MOST_SETS} are drawn; sow fewer \
                 `sets` on a square metre"
            )));
        }
        let sets = self.meadow.sets(&area);
        if sets.is_empty() {
            return Ok(None);
        }
        let count = sets.len() as u32;
        let storage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let store = |what, bytes, usage| Store::new(gpu, what, bytes, usage);
        let instances = store("sets of grass", 16 * u64::from(count), storage)?;
        crate::transfer::write(gpu, &instances.buffer, bytemuck::cast_slice(&sets))?;
        let kept = store("grass in sight", 4 * LISTS.len() as u64 * u64::from(count), storage)?;
        let draws = store("draws of grass", DRAW * LISTS.len() as u64, storage | BufferUsages::INDIRECT)?;
        let cull = bind(gpu, cull_layout, &[&self.grasses, &instances, &draws, &kept])?;
        let draw = bind(gpu, draw_layout, &[&self.grasses, &instances, &kept])?;
        Ok(Some(Sown { count, draws, cull, draw, _sets: instances, _kept: kept }))
    }
}

/// A uniform, and buffers of which some are only read.
fn layout(gpu: &Gpu, visibility: ShaderStages, read_only: &[bool]) -> BindGroupLayout {
    let storage = read_only.iter().map(|&read_only| BufferBindingType::Storage { read_only });
    let kinds = [BufferBindingType::Uniform].into_iter().chain(storage);
    let entries: Vec<_> = (0..)
        .zip(kinds)
        .map(|(binding, ty)| BindGroupLayoutEntry {
            binding,
            visibility,
            ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        })
        .collect();
    let description = BindGroupLayoutDescriptor { label: Some("grass"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

fn bind(gpu: &Gpu, layout: &BindGroupLayout, stores: &[&Store]) -> Result<BindGroup, Error> {
    let entries: Vec<_> = (0..)
        .zip(stores)
        .map(|(binding, store)| BindGroupEntry { binding, resource: store.buffer.as_entire_binding() })
        .collect();
    let description = BindGroupDescriptor { label: Some("grass"), layout, entries: &entries };
    gpu.context.attempt("binding grass", || Ok(gpu.context.device.create_bind_group(&description)))
}

const _: () = assert!(BLADES == 6, "as the lists count instances");
