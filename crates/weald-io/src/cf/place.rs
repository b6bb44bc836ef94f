//! Where the cells of a variable lie, from its coordinates and its grid mapping.

use super::super::Fault;
use super::attribute::{Attributes, Described, Source};
use super::axis::Centres;
use super::crs::{Crs, Unit};
use super::{CELL, GRID_MAPPING};
use weald_core::domain::Georeference;
use weald_core::grid::Size;

/// Sides of cells may differ by this share and still be called square or the same.
const SQUARE: f64 = 1e-6;

/// Where cells lie, and which way the rows of the file go.
#[derive(Debug, Default)]
pub(super) struct Place {
    /// Side of the cells in metres, where they are square.
    pub(super) cell: Option<f64>,
    pub(super) georeference: Option<Georeference>,
    /// Whether the first row of the file is the southern one.
    pub(super) is_south_up: bool,
    /// Metres in the unit of the heights, where the CRS has one for them.
    pub(super) vertical: Option<f64>,
    pub(super) notes: Vec<String>,
}

/// Coordinates along both axes, from the north-west, in units of the CRS.
#[derive(Clone, Copy)]
struct Grid {
    x: Centres,
    y: Centres,
    unit: Unit,
}

impl Place {
    /// The place of a variable whose last two dimensions are rows and columns.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for coordinates that are not even or run the wrong way.
    pub(super) fn of(source: &dyn Source, layer: &Described, size: Size) -> Result<Self, Fault> {
        let crs = grid_mapping(source, layer).map(Crs::of).transpose()?;
        let [rows, columns] = [2, 1].map(|behind| layer.dimensions[layer.dimensions.len() - behind].as_str());
        let (x, y) = (coordinate(source, columns, size.columns)?, coordinate(source, rows, size.rows)?);
        let vertical = crs.as_ref().and_then(|crs| crs.vertical);
        let (Some((x, along_x)), Some((y, along_y))) = (x, y) else {
            return Ok(Self { vertical, ..without_coordinates(crs, size) });
        };
        if is_along(along_x, columns, &NORTH) || is_along(along_y, rows, &EAST) {
            return Err(Fault::damaged(format!(
                "`{}` has its rows along `{rows}` and its columns along `{columns}`; with xarray: \
                 ds.transpose(..., '{columns}', '{rows}')",
                layer.name
            )));
        }
        let is_south_up = y.step().is_some_and(|step| step > 0.0);
        if x.step().is_some_and(|step| step < 0.0) {
            return Err(Fault::damaged(format!(
                "`{columns}` falls, but must rise from west to east; with xarray: ds.sortby('{columns}')"
            )));
        }
        let unit = unit(crs.as_ref(), [(along_x, columns), (along_y, rows)])?;
        let grid = Grid { x, y: if is_south_up { y.reversed() } else { y }, unit }.in_crs_units(crs.as_ref());
        let cell = source.attributes().number(CELL).filter(|cell| *cell > 0.0 && cell.is_finite());
        Ok(Self { is_south_up, vertical, ..grid.place(crs, cell) })
    }
}

/// What tells that coordinates go east or north: names of the variable, values of `standard_name` and of `axis`.
struct Direction {
    names: [&'static str; 3],
    standards: [&'static str; 2],
    axis: &'static str,
}

const EAST: Direction = Direction {
    names: ["lon", "longitude", "x"],
    standards: ["longitude", "projection_x_coordinate"],
    axis: "X",
};
const NORTH: Direction = Direction {
    names: ["lat", "latitude", "y"],
    standards: ["latitude", "projection_y_coordinate"],
    axis: "Y",
};

fn is_along(attributes: &Attributes, name: &str, direction: &Direction) -> bool {
    let by_standard = attributes.text("standard_name").map(|name| direction.standards.contains(&name));
    let by_axis = attributes.text("axis").map(|axis| axis == direction.axis);
    by_standard.or(by_axis).unwrap_or_else(|| direction.names.contains(&name))
}

/// The unit of both coordinates: as they say it, by their names, or by the CRS.
fn unit(crs: Option<&Crs>, along: [(&Attributes, &str); 2]) -> Result<Unit, Fault> {
    let [(along_x, x), (along_y, y)] = along;
    let (unit, other) = (Unit::of(along_x)?, Unit::of(along_y)?);
    if unit != other && ![unit, other].contains(&Unit::Unsaid) {
        return Err(Fault::damaged(format!("`{x}` and `{y}` are in different units; bring both to one")));
    }
    let said = if unit == Unit::Unsaid { other } else { unit };
    let is_angle = along.iter().any(|(attributes, name)| {
        let name = attributes.text("standard_name").unwrap_or(name);
        ["lon", "lat", "longitude", "latitude"].contains(&name)
    });
    let unit = match said {
        Unit::Unsaid if is_angle => Unit::Degrees,
        Unit::Unsaid => crs.map_or(Unit::Unsaid, Crs::unit),
        said => said,
    };
    crs.map(|crs| crs.ensure_in(unit)).transpose()?;
    Ok(unit)
}

impl Grid {
    /// Kilometres become metres, which CRSs have; feet stay what they are.
    fn in_crs_units(self, crs: Option<&Crs>) -> Self {
        match self.unit {
            Unit::Metres(metres) if metres >= 1000.0 && crs.is_none_or(|crs| crs.keys.is_none()) => {
                Self { x: self.x.times(metres), y: self.y.times(metres), unit: Unit::Metres(1.0) }
            }
            _ => self,
        }
    }

    /// `cell` is the side in metres as the file says it.
    fn place(&self, crs: Option<Crs>, cell: Option<f64>) -> Place {
        let metres = if let Unit::Metres(metres) = self.unit { metres } else { 1.0 };
        let affine = crs.as_ref().and_then(|crs| crs.transform).filter(|numbers| self.agrees_with(*numbers));
        let is_local = crs.is_none() && self.unit != Unit::Degrees;
        // A grid without a place begins at 0, so that its side follows from the attribute alone.
        let alone =
            cell.filter(|cell| is_local && self.agrees_with([0.0, *cell, cell * self.y.count as f64, -cell]));
        if let Some(cell) = alone {
            return Place { cell: Some(cell), ..Place::default() };
        }
        let Some(([west, width], [north, height])) = affine.map(pairs).or_else(|| self.corner_and_sides())
        else {
            let notes =
                vec!["one row or column of cells does not tell their side; the place is left out".to_owned()];
            return Place { notes, ..Place::default() };
        };
        let crs = crs.unwrap_or_default();
        let georeference = Georeference {
            epsg: crs.epsg,
            origin: [west, north],
            pixel: [width, height],
            keys: crs.keys_for(self.unit),
        };
        let is_square = (width - height).abs() <= SQUARE * width;
        let side = (is_square && !georeference.is_geographic()).then_some(width * metres);
        // In degrees nothing else tells the side in metres, so it counts as long as the cells are the same.
        let is_same = |cell: &f64| match side {
            Some(side) => (cell - side).abs() <= SQUARE * side,
            None => affine.is_some() && georeference.is_geographic(),
        };
        let cell = cell.filter(is_same).or(side);
        Place { cell, georeference: Some(georeference), ..Place::default() }
    }

    fn agrees_with(&self, [west, width, north, minus_height]: [f64; 4]) -> bool {
        let is_proper = width > 0.0 && minus_height < 0.0;
        is_proper && self.x.agree_with(west, width) && self.y.agree_with(north, minus_height)
    }

    /// West and width, north and height.
    fn corner_and_sides(&self) -> Option<([f64; 2], [f64; 2])> {
        let (width, height) = (self.x.step()?, -self.y.step()?);
        Some(([self.x.first - 0.5 * width, width], [self.y.first + 0.5 * height, height]))
    }
}

fn pairs([west, width, north, minus_height]: [f64; 4]) -> ([f64; 2], [f64; 2]) {
    ([west, width], [north, -minus_height])
}

/// A file of numbers alone, or with GDAL's transform.
fn without_coordinates(crs: Option<Crs>, size: Size) -> Place {
    let transform = crs.as_ref().and_then(|crs| crs.transform);
    if let Some([west, width, north, minus_height]) = transform
        && width > 0.0
        && minus_height < 0.0
    {
        let centres = |edge: f64, step: f64, count: usize| Centres {
            first: edge + 0.5 * step,
            last: edge + (count as f64 - 0.5) * step,
            count,
        };
        let (x, y) = (centres(west, width, size.columns), centres(north, minus_height, size.rows));
        let unit = crs.as_ref().map_or(Unit::Unsaid, Crs::unit);
        return Grid { x, y, unit }.place(crs, None);
    }
    let note = "the file has no coordinates; its first row is taken as the northern one";
    Place { notes: vec![note.to_owned()], ..Place::default() }
}

/// The attributes that tell the CRS of a variable.
fn grid_mapping<'a>(source: &'a dyn Source, layer: &'a Described) -> Option<&'a Attributes> {
    let named = layer.attributes.text("grid_mapping").and_then(|text| text.split([' ', ':']).next());
    let names = [named.unwrap_or(GRID_MAPPING), "crs"];
    let found = names.into_iter().find_map(|name| source.variables().iter().find(|other| other.name == name));
    // GDAL's Zarr has the definition beside the numbers themselves.
    let own = || Some(&layer.attributes).filter(|own| own.get("crs_wkt").is_some());
    found.map(|variable| &variable.attributes).or_else(own)
}

/// The coordinates along a dimension, and what is said of them.
fn coordinate<'a>(
    source: &'a dyn Source,
    dimension: &str,
    count: usize,
) -> Result<Option<(Centres, &'a Attributes)>, Fault> {
    let variables = source.variables();
    let is_along = |other: &Described| other.dimensions == [dimension] && other.shape == [count];
    let is_named = |other: &&Described| other.name == dimension && is_along(other);
    let is_axis = |other: &&Described| is_along(other) && is_coordinate(&other.attributes, &other.name);
    let found = variables.iter().find(is_named).or_else(|| variables.iter().find(is_axis));
    let Some(found) = found.filter(|found| found.is_number) else { return Ok(None) };
    let mut coordinates = vec![0.0; count];
    source.each(found, &mut |index, number| coordinates[index] = number)?;
    Ok(Some((Centres::of(&found.name, &coordinates)?, &found.attributes)))
}

/// Whether a variable of one dimension tells where cells lie along it.
fn is_coordinate(attributes: &Attributes, name: &str) -> bool {
    let standard = attributes.text("standard_name").unwrap_or_default();
    let standards = ["projection_x_coordinate", "projection_y_coordinate", "longitude", "latitude"];
    attributes.text("axis").is_some_and(|axis| ["X", "Y"].contains(&axis))
        || standards.contains(&standard)
        || ["x", "y", "lon", "lat", "longitude", "latitude"].contains(&name)
}
