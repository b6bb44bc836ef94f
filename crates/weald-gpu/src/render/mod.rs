//! Draws a landscape in real time, offscreen or into a window, by the same passes.
//!
//! What is drawn is a [`LitScene`](weald::picture::LitScene) of the library: its surfaces, colours, light and air, which the
//! ray-marched view draws as well, become textures and numbers once; each picture then takes a camera. The passes: what
//! throws shadows, where a cascade has become another one; depths of the ground by level of detail ([`lattice`]); cut sides,
//! grass and plants; then the light of what of the ground, the plain and the sky they leave in sight, all of it linear in
//! 16-bit floats with depth reversed. Tone mapping brings light to the numbers of a picture. [`renderer`] has their order.

mod blades;
mod canopy;
mod cascades;
mod casters;
mod chosen;
mod coming;
mod device;
mod field;
mod follow;
mod follower;
mod frame;
mod frustum;
mod grass;
mod grass_layer;
mod grass_look;
mod ground;
mod ground_pipelines;
mod in_sight;
mod instances;
mod kinds;
mod lattice;
mod layouts;
mod levels;
mod maps;
mod measure;
mod nearest;
mod onto;
mod options;
mod passes;
mod patch_heights;
mod picking;
mod picture;
mod plants;
mod records;
mod renderer;
mod reprojection;
mod returning;
mod runs;
mod screen;
mod shadows;
mod skyline;
mod sowing;
mod spacing;
mod tables;
mod targets;
mod terrain;
mod textures;
mod timing;
mod tone_mapping;
mod tried;
#[cfg(test)]
mod twins;
mod upload;

pub use chosen::Chosen;
pub use coming::SceneUpdate;
pub use grass_look::GrassLook;
pub use options::Options;
pub use picking::{Pick, PickedGround};
pub use renderer::{Renderer, TestLook};
pub use screen::Screen;
pub use timing::Timings;

/// What `weald bench --render` measures: fields of grass, from the standpoints of the publication's tables.
pub mod bench {
    pub use super::field::GrassStandpoint;
    pub use super::tables::{GrassRow, Measuring, OnRow, frame_budget, grass_tables};
}
