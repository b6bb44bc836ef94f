//! What the pipelines of a picture have in common: the layouts of their groups, and how they treat depth.

use wgpu::{
    BindGroupLayout, CompareFunction, DepthBiasState, DepthStencilState, StencilState, VertexAttribute,
    VertexBufferLayout, VertexStepMode,
};

use super::frame::Frame;
use super::maps::Maps;
use super::patch_heights::HeightsLayouts;
use super::targets::DEPTH;

/// Group of the scene's textures and uniforms.
pub(super) const STAGE_GROUP: u32 = 1;

/// The layouts of all groups.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layouts<'a> {
    pub(super) frame: &'a Frame,
    pub(super) maps: &'a Maps,
    /// Of the number of a cascade of the sun's depths.
    pub(super) cascade: &'a BindGroupLayout,
    /// Of the heights of patches.
    pub(super) heights: &'a HeightsLayouts,
}

/// What depth is compared with and whether it is kept.
pub(super) fn depth_state(depth_write: bool, compare: CompareFunction) -> DepthStencilState {
    DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(depth_write),
        depth_compare: Some(compare),
        stencil: StencilState::default(),
        bias: DepthBiasState::default(),
    }
}

/// A buffer of which all vertices of a draw read the same number.
pub(super) fn shared(attributes: &[VertexAttribute]) -> VertexBufferLayout<'_> {
    VertexBufferLayout { array_stride: 0, step_mode: VertexStepMode::Instance, attributes }
}
