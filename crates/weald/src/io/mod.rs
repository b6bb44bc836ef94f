//! Raster files, one file a format. The extension chooses the format; [`FORMATS`] is the registry.
//!
//! Every reader checks the sizes in a file's header against [`MAXIMUM_CELLS`](crate::grid::MAXIMUM_CELLS)
//! before it allocates; every writer writes under a temporary name and renames the whole file.

mod atomic;

pub use atomic::{write_whole, write_whole_with};

use std::path::Path;

use crate::domain::Georeference;
use crate::error::Error;
use crate::grid::{Field, Mask};

/// A grid of numbers with all that a file can say about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// The values; no-data cells hold 0.
    pub field: Field,
    /// Cells with data; `None` where all have.
    pub land: Option<Mask>,
    /// Side of a cell in metres, where the file says it and cells are square.
    pub cell: Option<f64>,
    /// Place on Earth.
    pub georeference: Option<Georeference>,
    /// Where the values came from.
    pub provenance: Option<Provenance>,
}

/// Where a file came from, written into every format that can carry it.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Version of Weald.
    pub version: String,
    /// BLAKE3 hash of the recipe, in hexadecimal.
    pub recipe_blake3: String,
    /// Seed of the landscape.
    pub seed: u64,
    /// Layer name.
    pub layer: String,
    /// Unit of the values.
    pub unit: String,
    /// Least and greatest value over the cells with data.
    pub range: (f64, f64),
}

/// Reads a file.
pub type Read = fn(&Path) -> Result<Raster, Error>;

/// Turns a raster into the bytes of a file.
pub type Encode = fn(&Raster) -> Result<Vec<u8>, Error>;

/// A raster format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// Name for messages.
    pub name: &'static str,
    /// Extensions in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Reads a file, where the format is read.
    pub read: Option<Read>,
    /// Writes one, where the format is written.
    pub encode: Option<Encode>,
}

/// All raster formats.
pub const FORMATS: &[Format] = &[];

/// The format of a file name.
///
/// # Errors
/// A sentence that names the extensions there are.
pub fn format_of(path: &Path) -> Result<&'static Format, String> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str())).ok_or_else(|| {
        let known: Vec<_> = FORMATS.iter().flat_map(|f| f.extensions).map(|e| format!(".{e}")).collect();
        format!("the extension of `{}` names no raster format; there are {}", path.display(), known.join(" "))
    })
}

/// Reads any raster file.
pub fn read(path: &Path) -> Result<Raster, Error> {
    let format = format_of(path).map_err(|what| Error::input(path, what))?;
    let read =
        format.read.ok_or_else(|| Error::input(path, format!("{} is written, not read", format.name)))?;
    read(path)
}

/// Writes a raster under its whole name only when all of it is on disk.
pub fn write(path: &Path, raster: &Raster) -> Result<(), Error> {
    let format = format_of(path).map_err(Error::Run)?;
    let encode = format.encode.ok_or_else(|| Error::Run(format!("{} is read, not written", format.name)))?;
    write_whole(path, &encode(raster)?)
}
