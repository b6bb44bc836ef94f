//! What a landscape becomes for other programs beyond one raster: meshes, vectors, sets of tiles, pages.
//! One file a kind; [`EXPORTS`] is the registry.

pub mod classes;
mod copies;
mod export;
mod grass;
mod layers;
mod mesh;
mod plants;
mod points;
mod registry;
pub mod report;
pub mod shades;
mod terrain3d;
mod terrain_tiles;
mod unity;
mod unreal;
mod vector;
mod vertices;

pub use export::{Export, ExportEntry, Finished};
pub use grass::GrassSets;
pub use layers::Layers;
pub use mesh::{Colours, Mesh};
pub use plants::PlantSet;
pub use points::Points;
pub use registry::{EXPORTS, find};
pub use terrain_tiles::Weight;
pub use terrain3d::Terrain3d;
pub use unity::Unity;
pub use unreal::Unreal;
pub use vector::{LakeAreas, RiverLines};
