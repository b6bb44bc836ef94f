//! Rivers and lakes as lines and areas for maps, in `GeoJSON`.

mod geojson;
mod lakes;
mod place;
mod rivers;

pub use lakes::LakeAreas;
pub use rivers::RiverLines;
