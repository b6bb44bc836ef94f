//! The pipelines of blades: strips of triangles that vertex shaders make alone.

use wgpu::{
    ColorTargetState, ColorWrites, CompareFunction, FragmentState, MultisampleState,
    PipelineCompilationOptions, PipelineLayout, PrimitiveState, PrimitiveTopology, RenderPipeline,
    RenderPipelineDescriptor, ShaderModule, VertexState,
};

use super::layouts::depth_state;
use super::targets::LIGHT;
use crate::gpu::context::Context;

/// A pipeline of strips without buffers, from a vertex entry point to `blade_fragment`.
pub(super) fn strips(
    context: &Context,
    (module, layout): (&ShaderModule, &PipelineLayout),
    vertex: &str,
    samples: u32,
) -> RenderPipeline {
    let target = ColorTargetState { format: LIGHT, blend: None, write_mask: ColorWrites::ALL };
    let make = || {
        context.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(vertex),
            layout: Some(layout),
            vertex: VertexState {
                module,
                entry_point: Some(vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState {
                topology: PrimitiveTopology::TriangleStrip,
                ..PrimitiveState::default()
            },
            depth_stencil: Some(depth_state(true, CompareFunction::Greater)),
            multisample: MultisampleState { count: samples, ..MultisampleState::default() },
            fragment: Some(FragmentState {
                module,
                entry_point: Some("blade_fragment"),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    context.known.drawing((module.clone(), format!("{vertex} {samples}")), make)
}
