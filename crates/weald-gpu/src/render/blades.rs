//! The pipelines of blades, whose vertices shaders make alone, and the corners of their triangles.
//!
//! One instance holds some sets: the vertices of a single blade fill no whole number of a processor's lanes, and for software
//! (llvmpipe) each instance is a draw of its own.

use weald::grow::grass::BLADES;
use weald::grow::grass::choice::LISTS;
use wgpu::{
    ColorTargetState, ColorWrites, CompareFunction, FragmentState, MultisampleState,
    PipelineCompilationOptions, PipelineLayout, PrimitiveState, RenderPipeline, RenderPipelineDescriptor,
    ShaderModule, VertexAttribute, VertexState, vertex_attr_array,
};

use super::layouts::{depth_state, shared};
use super::targets::LIGHT;
use crate::gpu::context::Context;

/// Sets of an instance, as `meadow.wgsl` has them.
const SETS_PER_INSTANCE: u16 = 8;

/// The corners of the triangles of an instance, list by list and blade by blade, for blades of so many rows: two triangles
/// between a row and the next, but one before the last, in which a blade ends in a point.
pub(super) fn corners(rows: [u32; LISTS]) -> Vec<u16> {
    let of_blade = |rows: u16, blade: u16| {
        let triangles = move |row: u16| {
            let both = [[0, 1, 2], [2, 1, 3]];
            let kept = if row + 2 == rows { 1 } else { 2 };
            both.into_iter().take(kept).flatten().map(move |corner| 2 * (blade * rows + row) + corner)
        };
        (0..rows.saturating_sub(1)).flat_map(triangles)
    };
    let blades = 0..SETS_PER_INSTANCE * BLADES as u16;
    let of_list = |rows: u32| blades.clone().flat_map(move |blade| of_blade(rows as u16, blade));
    rows.into_iter().flat_map(of_list).collect()
}

/// Where a list starts and where it ends, each a number that all vertices share.
const ENDS: [[VertexAttribute; 1]; 2] = [vertex_attr_array![0 => Uint32], vertex_attr_array![1 => Uint32]];

/// A pipeline from a vertex entry point to `blade_fragment`.
pub(super) fn pipeline(
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
                buffers: &ENDS.each_ref().map(|end| Some(shared(end))),
            },
            primitive: PrimitiveState::default(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_join_the_rows_of_each_blade_and_no_blades() {
        let rows = [20, 3, 0];
        let corners = corners(rows);
        let blades = usize::from(SETS_PER_INSTANCE) * BLADES as usize;
        assert_eq!(corners.len(), blades * 3 * (37 + 3));
        let (near, middle) = corners.split_at(blades * 3 * 37);
        for (list, rows) in [(near, 20), (middle, 3)] {
            for (number, triangle) in list.chunks_exact(3).enumerate() {
                let blade = number / (2 * rows - 3);
                assert!(triangle.iter().all(|corner| usize::from(*corner) / (2 * rows) == blade));
                let row = |corner: u16| usize::from(corner) % (2 * rows) / 2;
                let [least, most] =
                    [triangle.iter().min(), triangle.iter().max()].map(|at| row(*at.expect("three")));
                assert_eq!(most - least, 1, "{triangle:?}");
            }
            // The last blade's point is the first of its last two vertices, which lie in one place.
            assert_eq!(usize::from(*list.iter().max().expect("some")), 2 * rows * blades - 2);
        }
    }
}
