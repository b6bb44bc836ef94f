//! Brings light to the numbers of a picture: `tone_mapping.wgsl`.

use std::collections::BTreeMap;

use weald::Error;
use weald::picture::LitScene;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, Color, ColorTargetState, ColorWrites, CommandEncoder,
    FragmentState, LoadOp, MultisampleState, Operations, PipelineCompilationOptions, PipelineLayout,
    PipelineLayoutDescriptor, PrimitiveState, RenderPassColorAttachment, RenderPassDescriptor,
    RenderPipeline, RenderPipelineDescriptor, ShaderModule, ShaderStages, StoreOp, TextureFormat,
    TextureSampleType, TextureView, TextureViewDimension, VertexState,
};

use super::frame::Frame;
use super::layouts::STAGE_GROUP;
use super::maps::Maps;
use super::targets::Targets;
use super::timing::{Timer, Timestamp};
use crate::gpu::Gpu;

/// Its shaders, each after those that it calls.
const SHADERS: [&str; 3] =
    [include_str!("frame.wgsl"), include_str!("adaptation.wgsl"), include_str!("tone_mapping.wgsl")];

/// Group of the light that is brought to a picture.
const LIGHT_GROUP: u32 = 2;

/// The film, with a pipeline for each format that it was asked for.
#[derive(Debug)]
pub(super) struct ToneMapping {
    module: ShaderModule,
    layout: PipelineLayout,
    group: BindGroupLayout,
    pipelines: BTreeMap<String, RenderPipeline>,
}

impl ToneMapping {
    pub(super) fn new(gpu: &Gpu, scene: &LitScene, (frame, maps): (&Frame, &Maps)) -> Result<Self, Error> {
        let text = SHADERS.iter().fold(scene.shader(STAGE_GROUP), |text, shader| text + "\n" + shader);
        let device = &gpu.context.device;
        let entry = BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::FRAGMENT,
            ty: BindingType::Texture {
                sample_type: TextureSampleType::Float { filterable: false },
                view_dimension: TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        gpu.context.attempt_to_compile("making the tone mapping", || {
            let label = Some("tone_mapping");
            let group =
                device.create_bind_group_layout(&BindGroupLayoutDescriptor { label, entries: &[entry] });
            let layout = PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&frame.caster_layout), Some(&maps.layout), Some(&group)],
                immediate_size: 0,
            };
            Ok(Self {
                module: gpu.context.known.module(&gpu.context.device, "tone_mapping", text),
                layout: device.create_pipeline_layout(&layout),
                group,
                pipelines: BTreeMap::new(),
            })
        })
    }

    /// The light of a view, to be brought to its pictures.
    pub(super) fn light_of(&self, gpu: &Gpu, targets: &Targets) -> BindGroup {
        let resource = BindingResource::TextureView(&targets.light.view);
        let entries = [BindGroupEntry { binding: 0, resource }];
        let label = Some("tone_mapping");
        let description = BindGroupDescriptor { label, layout: &self.group, entries: &entries };
        gpu.context.device.create_bind_group(&description)
    }

    /// The pipeline for pictures of a format.
    pub(super) fn compile(&mut self, gpu: &Gpu, format: TextureFormat) -> Result<&RenderPipeline, Error> {
        let (module, layout) = (&self.module, &self.layout);
        Ok(match self.pipelines.entry(format!("{format:?}")) {
            std::collections::btree_map::Entry::Occupied(known) => known.into_mut(),
            std::collections::btree_map::Entry::Vacant(new) => {
                new.insert(gpu.context.attempt_to_compile("making the tone mapping", || {
                    Ok(pipeline(gpu, module, layout, format))
                })?)
            }
        })
    }

    /// Brings the light to a picture.
    pub(super) fn develop(
        &mut self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        ([frame, maps, light], timer): ([&BindGroup; 3], Option<&Timer>),
        target: &TextureView,
    ) -> Result<(), Error> {
        let pipeline = self.compile(gpu, target.texture().format())?;
        let ops = Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store };
        let attachment =
            RenderPassColorAttachment { view: target, depth_slice: None, resolve_target: None, ops };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("tone_mapping"),
            color_attachments: &[Some(attachment)],
            timestamp_writes: timer.map(|timer| timer.around(Timestamp::ToneMapping, [true; 2])),
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(STAGE_GROUP, maps, &[]);
        pass.set_bind_group(LIGHT_GROUP, light, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &ShaderModule,
    layout: &PipelineLayout,
    format: TextureFormat,
) -> RenderPipeline {
    let compilation_options = PipelineCompilationOptions::default();
    let target = ColorTargetState { format, blend: None, write_mask: ColorWrites::ALL };
    let make = || {
        gpu.context.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("tone_mapping"),
            layout: Some(layout),
            vertex: VertexState {
                module,
                entry_point: Some("tone_mapping_vertex"),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: None,
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module,
                entry_point: Some("tone_mapping_fragment"),
                compilation_options,
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    gpu.context.known.drawing((module.clone(), format!("{format:?}")), make)
}
