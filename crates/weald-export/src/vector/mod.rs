//! Rivers, lakes and plants as lines, areas and points for maps, in `GeoJSON`, with styles for QGIS.

pub(super) mod geojson;
mod lakes;
pub(super) mod place;
mod rivers;
pub(super) mod style;

pub use lakes::LakeAreas;
pub use rivers::RiverLines;
