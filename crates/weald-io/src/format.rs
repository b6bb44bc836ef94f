//! What a raster format is: how it is read and written, and what it can hold.

use std::collections::BTreeSet;
use std::fmt::Debug;
use std::ops::Range;
use std::path::Path;

use super::parts::{Part, PartName, Parts};
use super::{Classes, Fault, Limits, Raster, Shades, Spread};
use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::files::File;
use weald_core::grid::{Field, Size};
use weald_core::plane::Plane;

/// Turns the bytes of a file into a raster.
pub type DecodeFile = fn(&[u8], Limits) -> Result<Raster, Fault>;

/// How a raster comes out of a file.
#[derive(Clone, Copy, Debug)]
pub enum Decode {
    /// From the bytes of one file.
    File(DecodeFile),
    /// The same, and also some rows of it without the others.
    Rows {
        /// From the bytes of one file.
        whole: DecodeFile,
        /// Opens the file.
        open: fn(&Path) -> Result<Box<dyn RowsOfFile>, Fault>,
    },
    /// From a file and what lies beside it, or from a folder.
    Parts(fn(&dyn Parts, Limits) -> Result<Raster, Fault>),
}

/// A raster file of which rows are read as they are needed.
pub trait RowsOfFile: Debug + Send + Sync {
    /// Columns and rows of the whole.
    fn size(&self) -> Size;

    /// Rows that are decoded together: windows that begin and end with them decode none twice.
    fn rows_at_once(&self) -> usize;

    /// Most bytes of memory that reading those takes.
    fn bytes_at_once(&self) -> u64;

    /// Some rows, to the bit as in the whole, with all that the file says; the place is that of the whole.
    ///
    /// # Errors
    /// As the reader of the whole, where these rows show it.
    fn rows(&self, rows: Range<usize>) -> Result<Raster, Fault>;
}

/// How a raster becomes a file.
#[derive(Clone, Copy, Debug)]
pub enum Encode {
    /// The bytes of one file.
    File(fn(&Raster) -> Result<Vec<u8>, Error>),
    /// A file and what lies beside it, or a folder.
    Parts(fn(&Raster) -> Result<Vec<Part>, Error>),
    /// The same, and also of values that are not in memory.
    Windows {
        /// All files of a raster in memory.
        parts: fn(&Raster) -> Result<Vec<Part>, Error>,
        /// Writes the file, to the same bytes; gives what lies beside it.
        write: WriteWindows,
    },
    /// A folder, of which several can write files at the same time, each those of its own rows.
    Strips {
        /// All files of a raster in memory.
        parts: fn(&Raster) -> Result<Vec<Part>, Error>,
        /// The same files, some rows at a time.
        by_strips: ByStrips,
    },
}

/// How a raster becomes a folder some rows at a time.
#[derive(Clone, Copy, Debug)]
pub struct ByStrips {
    /// Rows of a strip: those from a multiple of it up to the next share files, and none with others.
    pub rows: usize,
    /// The files without values of a raster of so many columns and rows, whose own field counts for nothing.
    pub descriptions: fn(&Raster, Size) -> Result<Vec<Part>, Error>,
    /// The files of a strip.
    pub strip: fn(&Raster, StripPlace) -> Result<Vec<Part>, Error>,
}

/// Where a raster lies that is a strip of another.
#[derive(Clone, Copy, Debug)]
pub struct StripPlace {
    /// Columns and rows of the whole.
    pub whole: Size,
    /// Its first row in the whole.
    pub first: usize,
}

/// Writes a raster into a file window by window; gives the files beside it.
pub type WriteWindows = fn(&WindowedRaster<'_, '_>, &mut File) -> Result<Vec<Part>, Error>;

/// A raster whose values are read window by window.
pub struct WindowedRaster<'a, 'b> {
    /// All that it is but its values: its field and mask count for nothing.
    pub head: &'a Raster,
    /// The values, all of them finite where there are data.
    pub values: &'a dyn Plane<f32>,
    /// 1 in cells with data, else 0; all have without it.
    pub valid: Option<&'a dyn Plane<f32>>,
    /// Least and greatest value.
    pub range: (f32, f32),
    /// Makes room for smaller images.
    pub scratch: &'a dyn Fn(Size) -> Result<Box<dyn Plane<f32> + 'b>, Error>,
}

/// What a raster says of how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Nothing.
    Plain,
    /// Its values may stand for things.
    Classes,
    /// Its values are measures, with colours.
    Shades,
}

impl Encode {
    /// All files of the raster.
    ///
    /// # Errors
    /// [`Error::Run`] for values that the format cannot hold.
    pub fn parts(self, raster: &Raster) -> Result<Vec<Part>, Error> {
        match self {
            Self::File(encode) => Ok(vec![Part::own(encode(raster)?)]),
            Self::Parts(encode)
            | Self::Windows { parts: encode, .. }
            | Self::Strips { parts: encode, .. } => encode(raster),
        }
    }

    /// Names of all files that it may write of a raster that is drawn in such a way: those of two small ones, with a CRS
    /// and without, so that no format has to say them a second time.
    pub fn names(self, drawn: Drawn) -> Vec<PartName> {
        let small = |georeference| Raster {
            georeference,
            cell: Some(1.0),
            classes: (drawn == Drawn::Classes).then(|| Classes { named: Vec::new(), greatest: 2 }),
            shades: (drawn == Drawn::Shades)
                .then(|| Shades { spread: Spread::Even, colours: vec![[0; 3], [255; 3]] }),
            ..Raster::from(Field::from_function(Size { columns: 2, rows: 2 }, |x, y| (x + y) as f32))
        };
        let place = Georeference { epsg: Some(32633), origin: [5.0e5, 4.0e6], pixel: [1.0; 2], keys: None };
        let written = [None, Some(place)].map(|place| self.parts(&small(place)).unwrap_or_default());
        let names: BTreeSet<_> = written.into_iter().flatten().map(|part| part.name).collect();
        names.into_iter().collect()
    }
}

/// The numbers that a format stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// 32-bit floats: every value to the bit.
    Float32,
    /// Whole steps of a 65,535th of the range.
    Steps16,
    /// 16-bit floats: 11 significant bits, to 65,504.
    Float16,
}

/// What a raster knows beside its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metadata {
    /// Which cells have no data.
    NoData,
    /// The side of a cell.
    Cell,
    /// The georeferencing: CRS and origin.
    Place,
    /// A CRS that the format cannot express.
    Crs(CrsSupport),
    /// Where the values came from.
    Provenance,
}

/// Which CRSs a format can express.
#[derive(Clone, Copy, Debug)]
pub struct CrsSupport {
    /// Whether it can express the CRS of a place, if that has one.
    pub supports: fn(&Georeference) -> bool,
    /// What the user is informed of another CRS.
    pub loss: &'static str,
}

/// The same where the user is informed the same: addresses of functions tell nothing.
impl PartialEq for CrsSupport {
    fn eq(&self, other: &Self) -> bool {
        self.loss == other.loss
    }
}

impl Eq for CrsSupport {}

/// What of a raster a format can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The numbers.
    pub values: Values,
    /// What is left out.
    pub omits: &'static [Metadata],
}

impl Capabilities {
    /// All of it.
    pub const ALL: Self = Self { values: Values::Float32, omits: &[] };

    /// What of `raster` is lost, each a sentence for the user.
    pub fn losses(&self, raster: &Raster) -> Vec<String> {
        let values = match self.values {
            Values::Float32 => None,
            Values::Steps16 => Some("values are rounded to a 65,535th of their range"),
            Values::Float16 => Some("values are rounded to 11 significant bits"),
        };
        let omitted = self.omits.iter().filter(|knowledge| knowledge.is_in(raster)).map(|it| it.loss());
        values.into_iter().chain(omitted).map(str::to_owned).collect()
    }
}

impl Metadata {
    fn is_in(self, raster: &Raster) -> bool {
        match self {
            Self::NoData => raster.valid.is_some(),
            Self::Cell => raster.cell.is_some(),
            Self::Place => raster.georeference.is_some(),
            Self::Crs(crs) => raster.georeference.as_ref().is_some_and(|place| !(crs.supports)(place)),
            Self::Provenance => raster.provenance.is_some(),
        }
    }

    fn loss(self) -> &'static str {
        match self {
            Self::NoData => "cells without data are written as the lowest value",
            Self::Cell => "the side of a cell is left out",
            Self::Place => "the georeferencing (CRS and origin) is left out; .tif holds it",
            Self::Crs(crs) => crs.loss,
            Self::Provenance => "unit, seed and the hash of the recipe are left out; report.json has them",
        }
    }
}

/// A way to write a format for one reader that wants it its own way.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Word after `preset =`: the reader's name.
    pub name: &'static str,
    /// What is different, in one sentence.
    pub summary: &'static str,
    /// How it is written.
    pub encode: Encode,
    /// What it holds.
    pub holds: Capabilities,
}

/// A raster format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// Name for messages.
    pub name: &'static str,
    /// Extensions in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Reads a file, where the format is read.
    pub decode: Option<Decode>,
    /// Writes one, where the format is written.
    pub encode: Option<Encode>,
    /// What it can hold.
    pub holds: Capabilities,
    /// Ways to write it for particular readers.
    pub presets: &'static [Preset],
}

impl Format {
    /// How it is written, for one reader or for all.
    ///
    /// # Errors
    /// A sentence that names the presets there are, or that the format is not written.
    pub fn writing(&self, preset: Option<&str>) -> Result<(Encode, Capabilities), String> {
        let Some(name) = preset else {
            let encode = self.encode.ok_or_else(|| format!("{} is read, not written", self.name))?;
            return Ok((encode, self.holds));
        };
        let preset = self.presets.iter().find(|preset| preset.name == name).ok_or_else(|| {
            let known: Vec<_> = self.presets.iter().map(|preset| preset.name).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            format!("{} has no preset {name:?}; it has: {known}", self.name)
        })?;
        Ok((preset.encode, preset.holds))
    }
}
