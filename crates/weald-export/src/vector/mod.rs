//! Rivers and lakes as lines and areas for maps, in `GeoJSON`.

pub(super) mod geojson;
mod lakes;
pub(super) mod place;
mod rivers;

pub use lakes::LakeAreas;
pub use rivers::RiverLines;
