//! What arrays say of themselves by the Climate and Forecast conventions (CF 1.11): the common part of `NetCDF`
//! files and Zarr groups.
//!
//! Written: dimensions `y` and `x` with the centres of the cells as coordinates (row 0 is north, so `y` falls, but
//! for landlab, which counts from the south), a variable a layer with `units`, `long_name`, `standard_name` where
//! CF has one and `landlab_name` where landlab has one, and a variable `spatial_ref` that holds the CRS three
//! times, for readers of CF (`grid_mapping_name` and its parameters), of WKT (`crs_wkt`) and of GDAL
//! (`spatial_ref`, `GeoTransform`). No-data is NaN, provenance is attributes. Numbers that coordinates alone would
//! round (the side of a cell, the corner) stand beside them, and are believed on reading as long as the coordinates
//! agree.
//!
//! Read: a variable over (rows, columns), rising or falling `y`, packed or not, in metres, kilometres, feet or
//! degrees; see [`read`].

mod attribute;
mod axis;
mod crs;
mod dataset;
mod mapping;
mod names;
mod place;
mod read;

pub use attribute::{Attribute, Attributes, Described, Source};
pub use axis::Axis;
pub(super) use crs::OMITTED_CRS;
pub use crs::{OMITTED_CRS_NOTE, is_readable_by_all};
pub use dataset::{Cells, Dataset, Layer, NO_CLASS, Order, Sheet, Values, Variable};
pub use names::Names;
pub use read::read;

/// Name of the variable that holds the CRS, as GDAL and rioxarray write it.
const GRID_MAPPING: &str = "spatial_ref";
/// Attribute with the side of the cells in metres.
const CELL: &str = "WEALD_CELL_METRES";
/// Attribute with the place as GDAL writes it: west, width, 0, north, 0, minus height.
const GEO_TRANSFORM: &str = "GeoTransform";
