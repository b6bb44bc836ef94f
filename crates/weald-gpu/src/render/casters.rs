//! What throws shadows, as it is drawn into the sun's depths: `casters.wgsl`.

use wgpu::{RenderPass, RenderPipeline};

use super::terrain::Terrain;

/// The pipelines of what throws shadows.
#[derive(Debug)]
pub(super) struct Casters {
    pub(super) ground: RenderPipeline,
    pub(super) beyond: Option<RenderPipeline>,
    pub(super) sides: RenderPipeline,
    pub(super) rims: RenderPipeline,
}

impl Casters {
    /// Draws the casters of a view, 1 for the first cascade.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>, terrain: &Terrain, view: usize) {
        pass.set_pipeline(&self.ground);
        terrain.draw_ground(pass, view);
        if let Some(beyond) = &self.beyond {
            pass.set_pipeline(beyond);
            terrain.draw_beyond(pass, view);
        }
        pass.set_pipeline(&self.sides);
        terrain.draw_sides(pass, view);
        pass.set_pipeline(&self.rims);
        terrain.draw_rims(pass);
    }
}
