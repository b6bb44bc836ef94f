//! Raster files, one file a format. The extension chooses the format; [`FORMATS`] is the registry.
//!
//! Every reader works on bytes, so that it can be fuzzed without a file system, and checks the sizes in a
//! header against its [`Limits`] before it allocates; every writer writes under a temporary name and renames
//! the whole file.
//!
//! Features, all on by default: `exr` for OpenEXR, `zstd` for Zarr arrays that are packed with Zstandard, `wkt` for the
//! definition of CRSs in `NetCDF` and Zarr as other programs read it. A build without one names it where a file asks for it.

pub mod asc;
mod atomic;
mod beside;
pub mod cf;
mod classes;
mod deflate;
#[cfg(feature = "exr")]
pub mod exr;
mod format;
mod geokeys;
pub mod geotiff;
mod info;
mod limits;
pub mod memory;
pub mod netcdf;
pub mod npy;
mod number;
mod parts;
pub mod png;
pub mod png16;
mod provenance;
mod raster;
pub mod raw;
mod registry;
mod regrid;
mod said;
mod shades;
mod square;
mod unit;
mod web_mercator;
mod wkt;
pub mod zarr;

pub use atomic::{
    make_folders, remove_leftovers, rename, replace_folder, write_into, write_parts, write_through,
    write_whole, write_whole_with,
};
pub use classes::{Class, Classes};
pub use format::{
    ByStrips, Capabilities, CrsSupport, Decode, DecodeFile, Drawn, Encode, Format, Metadata, Preset,
    RowsOfFile, StripPlace, Values, WindowedRaster, WriteWindows,
};
pub use info::{Info, describe};
pub use limits::{Fault, Limits};
pub use parts::{InMemory, Part, PartName, Parts, read_at_most};
pub use provenance::Provenance;
pub use raster::Raster;
pub use registry::{FORMATS, format_of, open_rows, read, write};
pub use regrid::{Grid, Resampling, regrid};
pub use said::Said;
pub use shades::{Shades, Spread};
pub use square::square;
pub use unit::metres_in;
