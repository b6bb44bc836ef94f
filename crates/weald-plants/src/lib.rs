//! What grows on the land: plants from the codes of fractals, and where they stand.

mod fractal;
pub mod grass;
pub mod grass_step;
pub mod ifs;
pub mod scatter;
mod shaders;
mod vegetation;
pub mod wind;

pub use fractal::Fractal;
pub use shaders::SHADERS;
pub use vegetation::Vegetation;
