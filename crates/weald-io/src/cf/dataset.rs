//! What goes into a file, one grid and the layers on it; and its arrays and attributes, ready to be packed as `NetCDF` or
//! Zarr.

use std::borrow::Cow;

use super::super::{Classes, Provenance, Raster, provenance};
use super::attribute::{Attribute, Attributes};
use super::axis::Axis;
use super::crs;
use super::names::{of_layer, udunits};
use super::{CELL, GRID_MAPPING, Names};
use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::layer_words::meaning;

/// Layers of one grid that become one file.
#[derive(Clone, Debug)]
pub struct Sheet<'a> {
    /// Side of a cell in metres, where it is known.
    pub cell: Option<f64>,
    /// Where on Earth it lies.
    pub georeference: Option<&'a Georeference>,
    /// Cells with data; `None` where all have.
    pub valid: Option<&'a Mask>,
    /// At least one; all of one size.
    pub layers: Vec<Layer<'a>>,
    /// What the arrays are called.
    pub names: Names,
}

/// A field and where it came from.
#[derive(Clone, Debug)]
pub struct Layer<'a> {
    /// The field.
    pub field: &'a Field,
    /// Where it came from.
    pub provenance: Option<Provenance>,
    /// Unit of its values, where they are not Weald's own.
    pub unit: Option<String>,
    /// What its values stand for, where they are whole numbers.
    pub classes: Option<Cow<'a, Classes>>,
}

impl<'a> Sheet<'a> {
    /// One raster.
    pub fn of(raster: &'a Raster, names: Names) -> Self {
        Self {
            cell: raster.cell,
            georeference: raster.georeference.as_ref(),
            valid: raster.valid.as_ref(),
            layers: vec![Layer {
                field: &raster.field,
                provenance: raster.provenance.clone(),
                unit: raster.unit.clone(),
                classes: raster.classes.as_ref().map(Cow::Borrowed),
            }],
            names,
        }
    }

    /// Whether the first row of the file is the southern one, as landlab counts its nodes; others go by the
    /// coordinates.
    pub(super) fn is_south_up(&self) -> bool {
        self.names == Names::Landlab
    }

    /// Whether a layer of degrees is written as rise over run, which is what landlab calls a slope.
    fn makes_tangents(&self, layer: &Layer<'_>) -> bool {
        let is_slope = |said: &Provenance| said.layer == "slope" && said.unit == "deg";
        self.names == Names::Landlab && layer.provenance.as_ref().is_some_and(is_slope)
    }

    /// The layer with what is said of the values that are written.
    fn as_written(&self, layer: &Layer<'a>) -> Layer<'a> {
        let mut written = layer.clone();
        if let Some(said) = written.provenance.as_mut().filter(|_| self.makes_tangents(layer)) {
            "1".clone_into(&mut said.unit);
            said.range = (tangent(said.range.0), tangent(said.range.1));
        }
        written
    }

    pub(super) fn size(&self) -> Size {
        self.layers[0].field.size()
    }

    /// Whether all values can be written.
    ///
    /// # Errors
    /// [`Error::Run`] naming the first cell with data that holds a NaN or an infinity.
    pub(super) fn ensure_finite(&self) -> Result<(), Error> {
        for layer in &self.layers {
            if let Some((x, y)) = layer.field.first_not_finite(self.valid) {
                let name = layer.name().map_or_else(String::new, |name| format!(" of layer `{name}`"));
                return Err(Error::Run(format!(
                    "column {x}, row {y}{name} holds {}, which no file may carry as data",
                    layer.field.at(x, y)
                )));
            }
        }
        Ok(())
    }
}

impl Layer<'_> {
    /// Its name, where that is known.
    pub(super) fn name(&self) -> Option<&str> {
        self.provenance.as_ref().map(|provenance| provenance.layer.as_str())
    }
}

/// All of a file.
#[derive(Debug)]
pub struct Dataset<'a> {
    /// Columns and rows of all grids in it.
    pub size: Size,
    /// Attributes of the whole.
    pub attributes: Attributes,
    /// Its arrays.
    pub variables: Vec<Variable<'a>>,
}

/// One array.
#[derive(Debug)]
pub struct Variable<'a> {
    /// Its name.
    pub name: String,
    /// Its attributes.
    pub attributes: Attributes,
    /// Its numbers.
    pub values: Values<'a>,
}

/// The numbers of an array, and by that its dimensions.
#[derive(Debug)]
pub enum Values<'a> {
    /// A number without a dimension, there for its attributes.
    Nothing,
    /// Centres of the cells along an axis.
    Along(Axis, Vec<f64>),
    /// A number a cell, over (`y`, `x`); NaN without data.
    Cells(Cells<'a>),
}

/// The values of a layer, in the order of the file's rows.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    field: &'a Field,
    valid: Option<&'a Mask>,
    is_south_up: bool,
    are_whole: bool,
    /// Whether the values are degrees of slope that are written as rise over run.
    are_tangents: bool,
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug)]
pub enum Order {
    /// The most significant first.
    Big,
    /// The least significant first.
    Little,
}

/// The whole number of cells without data.
pub const NO_CLASS: i32 = -1;

/// Rise over run of a slope in degrees.
fn tangent(degrees: f64) -> f64 {
    libm::tan(degrees.to_radians())
}

/// Name of a layer of which nothing is known.
const NAMELESS: &str = "layer";

impl<'a> Dataset<'a> {
    /// # Errors
    /// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
    pub fn of(sheet: &Sheet<'a>) -> Result<Self, Error> {
        Self::on(sheet, sheet.size())
    }

    /// The same of layers that are some rows of a grid of so many columns and rows.
    ///
    /// # Errors
    /// As [`Dataset::of`].
    pub fn on(sheet: &Sheet<'a>, size: Size) -> Result<Self, Error> {
        sheet.ensure_finite()?;
        let mut variables = coordinates(sheet, size);
        let grid_mapping = sheet.georeference.map(|place| Variable {
            name: GRID_MAPPING.to_owned(),
            attributes: crs::attributes(place),
            values: Values::Nothing,
        });
        variables.extend(grid_mapping);
        let layers: Vec<_> = sheet.layers.iter().map(|layer| layer.name().unwrap_or(NAMELESS)).collect();
        let names = sheet.names.of_variables(&layers, &["y", "x", GRID_MAPPING]);
        let is_south_up = sheet.is_south_up();
        let cells = sheet.layers.iter().zip(names).map(|(layer, name)| Variable {
            name,
            attributes: layer_attributes(&sheet.as_written(layer), sheet.georeference.is_some()),
            values: Values::Cells(Cells {
                field: layer.field,
                valid: sheet.valid,
                is_south_up,
                are_whole: layer.classes.is_some(),
                are_tangents: sheet.makes_tangents(layer),
            }),
        });
        variables.extend(cells);
        Ok(Self { size, attributes: file_attributes(sheet), variables })
    }
}

impl Values<'_> {
    /// The dimensions, slowest first.
    pub fn axes(&self) -> &'static [Axis] {
        match self {
            Self::Nothing => &[],
            Self::Along(Axis::Y, _) => &[Axis::Y],
            Self::Along(Axis::X, _) => &[Axis::X],
            Self::Cells(..) => &[Axis::Y, Axis::X],
        }
    }
}

impl Cells<'_> {
    /// Columns and rows.
    pub fn size(&self) -> Size {
        self.field.size()
    }

    /// Whether they are whole numbers, 0 or more.
    pub fn are_whole(&self) -> bool {
        self.are_whole
    }

    /// The bytes of a value in 32 bits: a float, or a whole number that is [`NO_CLASS`] without data.
    pub fn bytes(&self, value: f32, order: Order) -> [u8; 4] {
        let bits = match (self.are_whole, value.is_nan()) {
            (false, _) => value.to_bits(),
            (true, true) => NO_CLASS.cast_unsigned(),
            (true, false) => value as u32,
        };
        match order {
            Order::Big => bits.to_be_bytes(),
            Order::Little => bits.to_le_bytes(),
        }
    }

    /// The value in a column and a row of the file; NaN without data.
    pub fn at(&self, x: usize, row: usize) -> f32 {
        let y = if self.is_south_up { self.size().rows - 1 - row } else { row };
        if !self.valid.is_none_or(|valid| valid.is_valid(x, y)) {
            return f32::NAN;
        }
        let value = self.field.at(x, y);
        if self.are_tangents { tangent(value.into()) as f32 } else { value }
    }
}

/// The centres of the cells, where the corner and the side of a cell are known.
fn coordinates<'a>(sheet: &Sheet<'_>, size: Size) -> Vec<Variable<'a>> {
    let local = sheet.cell.map(|cell| Georeference {
        epsg: None,
        origin: [0.0, cell * size.rows as f64],
        pixel: [cell; 2],
        keys: None,
    });
    let Some(place) = sheet.georeference.or(local.as_ref()) else { return Vec::new() };
    let centre = |at: usize| place.at([at as f64 + 0.5; 2]);
    let mut y: Vec<f64> = (0..size.rows).map(|row| centre(row)[1]).collect();
    if sheet.is_south_up() {
        y.reverse();
    }
    let x = (0..size.columns).map(|column| centre(column)[0]).collect();
    [(Axis::Y, y), (Axis::X, x)]
        .map(|(axis, centres)| Variable {
            name: axis.name().to_owned(),
            attributes: crs::axis_attributes(axis, sheet.georeference),
            values: Values::Along(axis, centres),
        })
        .into()
}

/// Keys of a provenance that hold for one layer alone.
const OF_LAYER: [&str; 5] =
    [provenance::LAYER, provenance::UNIT, provenance::MINIMUM, provenance::MAXIMUM, provenance::RESAMPLED];

fn file_attributes(sheet: &Sheet<'_>) -> Attributes {
    let mut attributes = Attributes::default();
    attributes.add("Conventions", "CF-1.11");
    if let Some(provenance) = sheet.layers.iter().find_map(|layer| layer.provenance.as_ref()) {
        attributes.add("source", format!("Weald {}", provenance.version));
        let items = provenance.items().into_iter().filter(|(key, _)| !OF_LAYER.contains(key));
        items.for_each(|(key, text)| attributes.add(key, text));
    }
    if let Some(cell) = sheet.cell {
        attributes.add(CELL, cell);
    }
    attributes
}

fn layer_attributes(layer: &Layer<'_>, is_placed: bool) -> Attributes {
    let mut attributes = Attributes::default();
    if let Some(provenance) = &layer.provenance {
        let known = of_layer(&provenance.layer);
        let long = meaning(&provenance.layer).unwrap_or(&provenance.layer);
        let per_iteration = if provenance.unit.ends_with("/step") { ", per iteration" } else { "" };
        attributes.add("long_name", format!("{long}{per_iteration}"));
        let standard = known.and_then(|known| known.standard);
        if let Some(name) = standard {
            attributes.add("standard_name", name);
        }
        let landlab = known.and_then(|known| known.landlab);
        if let Some(name) = landlab {
            attributes.add("landlab_name", name);
        }
        attributes.add("units", udunits(&provenance.unit));
        let items = provenance.items().into_iter().filter(|(key, _)| OF_LAYER.contains(key));
        items.for_each(|(key, text)| attributes.add(key, text));
    } else if let Some(unit) = &layer.unit {
        attributes.add("units", udunits(unit));
    }
    if layer.classes.is_some() {
        attributes.add("_FillValue", Attribute::Integers(vec![NO_CLASS]));
    }
    if let Some(classes) = layer.classes.as_ref().filter(|classes| classes.named.len() <= MAX_FLAGS) {
        let (numbers, meanings) = flags(classes);
        attributes.add("flag_values", Attribute::Integers(numbers));
        attributes.add("flag_meanings", meanings);
    }
    if is_placed {
        attributes.add("grid_mapping", Attribute::from(GRID_MAPPING));
    }
    attributes
}

/// Most classes whose meaning is said.
const MAX_FLAGS: usize = 4096;

/// Numbers and what each means, as CF 3.5 has them: words with a blank between, each of letters, digits and underscores.
fn flags(classes: &Classes) -> (Vec<i32>, String) {
    let word = |name: &str| {
        let legal = |letter: char| letter.is_ascii_alphanumeric() || "_-.+@".contains(letter);
        name.chars().map(|letter| if legal(letter) { letter } else { '_' }).collect::<String>()
    };
    let words: Vec<String> = classes.named.iter().map(|class| word(&class.name)).collect();
    (classes.named.iter().map(|class| class.number as i32).collect(), words.join(" "))
}
