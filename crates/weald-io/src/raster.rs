//! The common ground of all raster formats.

use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

use super::unit::Measure;
use super::{Classes, Fault, Provenance, Shades};

/// Numbers that may stand for no-data, in the order in which they are tried before NaN.
const NO_DATA: [f32; 2] = [-9999.0, -99999.0];

/// What the user should know of values of 8 bits.
const EIGHT_BITS: &str =
    "if these are heights, 8 bits hold 256 of them, so slopes come out as terraces; 16 bits do not";

/// A grid of numbers with all that a file can say about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// The values; no-data cells hold 0.
    pub field: Field,
    /// Cells with data; `None` where all have.
    pub valid: Option<Mask>,
    /// Side of a cell in metres, where the file says it and cells are square.
    pub cell: Option<f64>,
    /// Where on Earth it lies.
    pub georeference: Option<Georeference>,
    /// Where the values came from.
    pub provenance: Option<Provenance>,
    /// What the values stand for, where all are whole numbers that stand for things; formats that have whole numbers then
    /// store such.
    pub classes: Option<Classes>,
    /// How other programs are to draw its measures.
    pub shades: Option<Shades>,
    /// Unit of the values of a file that Weald did not write: `m` where it has a length in any unit, or what it says;
    /// `None` where it says none.
    pub unit: Option<String>,
    /// Type of the values in the file: `int16`, `float32` …
    pub stored: &'static str,
    /// What the user should know about the file.
    pub notes: Vec<String>,
}

impl From<Field> for Raster {
    /// A raster that says nothing beyond its values.
    fn from(field: Field) -> Self {
        Self {
            field,
            valid: None,
            cell: None,
            georeference: None,
            provenance: None,
            classes: None,
            shades: None,
            unit: None,
            stored: "float32",
            notes: Vec::new(),
        }
    }
}

impl Raster {
    /// A raster from values as read and the flags of the cells with data.
    ///
    /// # Errors
    /// [`Fault::Damaged`] naming the first cell with data that holds a NaN or an infinity.
    /// Readers take NaN as no-data, whether a file declares it or not: it is no height.
    pub(super) fn from_file(
        size: Size,
        values: Vec<f32>,
        valid: Vec<bool>,
        stored: &'static str,
    ) -> Result<Self, Fault> {
        Self::from_rows((size, 0), values, valid, stored)
    }

    /// The same for rows of a file from one of them on.
    pub(super) fn from_rows(
        (size, first): (Size, usize),
        values: Vec<f32>,
        valid: Vec<bool>,
        stored: &'static str,
    ) -> Result<Self, Fault> {
        let (field, valid) = (Field::from_values(size, values), Mask::new(size, valid));
        if let Some((x, y)) = field.first_not_finite(valid.as_ref()) {
            return Err(Fault::Damaged(format!(
                "column {x}, row {} holds {}, which is no height; declare it as no-data (for a GeoTIFF: \
                 gdal_translate -a_nodata inf) or mend the file",
                first + y,
                field.at(x, y)
            )));
        }
        let notes = if stored.ends_with("int8") { vec![EIGHT_BITS.to_owned()] } else { Vec::new() };
        Ok(Self { valid, stored, notes, ..Self::from(field) })
    }

    /// With the unit of a measure, and what the user should know of it.
    pub(super) fn measured(mut self, measure: &Measure) -> Self {
        self.unit = measure.unit();
        self.notes.extend(measure.notes());
        self
    }

    /// With what a file says of its source, whose unit then counts.
    pub(super) fn with_source(mut self, provenance: Option<Provenance>) -> Self {
        if provenance.is_some() {
            // Weald writes no heights in 8 bits, but classes.
            self.notes.retain(|note| note != EIGHT_BITS);
        }
        let unit = self.unit.filter(|_| provenance.is_none());
        Self { provenance, unit, ..self }
    }

    /// Unit of the values, where it is known.
    pub fn unit(&self) -> Option<&str> {
        let own = self.provenance.as_ref().map(|provenance| provenance.unit.as_str());
        own.or(self.unit.as_deref())
    }

    /// Whether the cell at a row-major position holds data.
    pub(super) fn is_valid_at(&self, index: usize) -> bool {
        self.valid.as_ref().is_none_or(|valid| valid.is_valid_at(index))
    }

    /// Least and greatest value over the cells with data; both 0 where none has.
    pub(super) fn range(&self) -> (f32, f32) {
        self.field.range(self.valid.as_ref()).unwrap_or_default()
    }

    /// A number that no cell with data holds, for no-data cells; NaN where the usual ones are within the range.
    pub(super) fn number_for_no_data(&self) -> f32 {
        number_for_no_data(self.range())
    }

    /// Whether the values can go into a file of finite numbers.
    ///
    /// # Errors
    /// [`Error::Run`] naming the first cell that holds a NaN or an infinity.
    pub(super) fn ensure_finite(&self) -> Result<(), Error> {
        match self.field.first_not_finite(self.valid.as_ref()) {
            None => Ok(()),
            Some((x, y)) => Err(Error::Run(format!(
                "column {x}, row {y} holds {}, which no file may carry as data",
                self.field.at(x, y)
            ))),
        }
    }
}

/// The same for values of this range.
pub(super) fn number_for_no_data((low, high): (f32, f32)) -> f32 {
    NO_DATA.into_iter().find(|number| !(low..=high).contains(number)).unwrap_or(f32::NAN)
}
