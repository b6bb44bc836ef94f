//! Square cells in metres, whatever the cells of the file are.
//!
//! Degrees become metres by the latitude φ of the raster's middle. On the ellipsoids of WGS 84 and GRS 80, which are the
//! same within a tenth of a millimetre, by the series of the National Geospatial-Intelligence Agency (after Snyder 1987,
//! Map Projections: A Working Manual, eq. 3-21 and 4-19):
//!
//! a degree of latitude = 111132.92 − 559.82 cos 2φ + 1.175 cos 4φ − 0.0023 cos 6φ metres,
//! a degree of longitude = 111412.84 cos φ − 93.5 cos 3φ + 0.118 cos 5φ metres.
//!
//! On any other ellipsoid that the file or its CRS names, with semi-major axis a and eccentricity e (the same, eq. 4-18
//! and 4-20): a (1 − e²) / (1 − e² sin² φ)^1.5 and a cos φ / (1 − e² sin² φ)^0.5 a radian.
//!
//! The side of the new cells is the finer of the two; only the coarser direction is resampled, linearly. The
//! corners stay where they are, so cells are square to within half a cell over the whole extent. Between 60°
//! north and south a raster of one degree is at most 1.5 % wider at one edge than the metres say.

use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

use super::Raster;
use super::geokeys::{ellipsoid, metres_per_unit};
use super::web_mercator::true_cell;
use super::wkt::Ellipsoid;

/// Least side of a cell in metres: below, the unit is another one.
const LEAST_SIDE: f64 = 0.001;

/// A raster of square cells with their side in metres, and a sentence for the user where that took a change.
///
/// # Errors
/// [`Error::Run`] where the raster says nothing of the size of its cells, these are below a millimetre, or it lies beyond
/// a pole;
/// [`Error::Limit`] where the resampled raster would be too large.
pub fn square(raster: Raster) -> Result<(Raster, Option<String>), Error> {
    if let Some((cell, note)) = true_cell(&raster)? {
        ensure_side(cell)?;
        return Ok((Raster { cell: Some(cell), ..raster }, Some(note)));
    }
    if let Some(cell) = raster.cell {
        ensure_side(cell)?;
        return Ok((raster, None));
    }
    let Some(place) = raster.georeference.clone() else {
        return Err(Error::Run(
            "the file does not say how large its cells are; give `cell`, in metres".to_owned(),
        ));
    };
    let old = raster.field.size();
    let sides = Sides::of(&place, old)?;
    ensure_side(sides.finer())?;
    let size = sides.square_size(old)?;
    let pixel = [
        place.pixel[0] * (old.columns as f64 / size.columns as f64),
        place.pixel[1] * (old.rows as f64 / size.rows as f64),
    ];
    let georeference = Some(Georeference { pixel, ..place });
    let squared = Raster { cell: Some(sides.finer()), georeference, ..resample(raster, size) };
    Ok((squared, Some(sides.note(size, old))))
}

fn ensure_side(side: f64) -> Result<(), Error> {
    if side >= LEAST_SIDE && side.is_finite() {
        return Ok(());
    }
    Err(Error::Run(format!(
        "its cells are {side:e} m wide, but must be at least {LEAST_SIDE} m: its coordinates are in another unit than it \
         says; set their CRS with gdal_edit.py -a_srs"
    )))
}

/// Sides of the cells as they are.
struct Sides {
    /// West to east, in metres.
    width: f64,
    /// North to south, in metres.
    height: f64,
    /// Latitude of the middle in degrees, for a raster in degrees.
    latitude: Option<f64>,
    ellipsoid: Option<Ellipsoid>,
}

impl Sides {
    fn of(place: &Georeference, size: Size) -> Result<Self, Error> {
        if !place.is_geographic() {
            let metres =
                metres_per_unit(place.keys.as_ref()).map_err(|fault| Error::Run(fault.to_string()))?;
            return Ok(Self {
                width: place.pixel[0] * metres,
                height: place.pixel[1] * metres,
                latitude: None,
                ellipsoid: None,
            });
        }
        let [_, latitude] = place.middle(size);
        if latitude.abs() >= 90.0 {
            return Err(Error::Run(format!(
                "the middle of the file lies at latitude {latitude}°, but must lie between the poles"
            )));
        }
        let ellipsoid = ellipsoid(place);
        let (longitude_metres, latitude_metres) = metres_per_degree(latitude, ellipsoid);
        Ok(Self {
            width: place.pixel[0] * longitude_metres,
            height: place.pixel[1] * latitude_metres,
            latitude: Some(latitude),
            ellipsoid,
        })
    }

    fn finer(&self) -> f64 {
        self.width.min(self.height)
    }

    /// The size in square cells; at least one cell in each direction.
    fn square_size(&self, size: Size) -> Result<Size, Error> {
        let columns = (size.columns as f64 * (self.width / self.finer())).round().max(1.0);
        let rows = (size.rows as f64 * (self.height / self.finer())).round().max(1.0);
        Size::new(columns as usize, rows as usize)
    }

    /// The ellipsoid, where it is not the usual one.
    fn figure(&self) -> String {
        match self.ellipsoid {
            None => " on the ellipsoid of WGS 84, since the file names none".to_owned(),
            Some(usual) if is_usual(usual) => String::new(),
            Some(Ellipsoid { semi_major, inverse_flattening: 0.0 }) => {
                format!(" on a sphere of {semi_major} m")
            }
            Some(Ellipsoid { semi_major, inverse_flattening }) => {
                format!(" on an ellipsoid of {semi_major} m, flattened by 1/{inverse_flattening}")
            }
        }
    }

    fn note(&self, size: Size, old: Size) -> String {
        let start = match self.latitude {
            Some(latitude) => {
                format!("degrees became metres at latitude {latitude:.2}°{}: cells", self.figure())
            }
            None => "cells".to_owned(),
        };
        let Self { width, height, .. } = self;
        let side = self.finer();
        if size == old {
            return format!("{start} of {width:.1} × {height:.1} m count as {side:.1} m squares, {size}");
        }
        format!("{start} of {width:.1} × {height:.1} m were resampled to {side:.1} m squares, {size}")
    }
}

/// Whether an ellipsoid is that of WGS 84 or GRS 80.
fn is_usual(ellipsoid: Ellipsoid) -> bool {
    ellipsoid.semi_major == 6_378_137.0 && (ellipsoid.inverse_flattening - 298.257_222).abs() < 1e-5
}

/// Metres in a degree of longitude and in a degree of latitude; without an ellipsoid, on that of WGS 84.
fn metres_per_degree(latitude: f64, ellipsoid: Option<Ellipsoid>) -> (f64, f64) {
    if let Some(Ellipsoid { semi_major, inverse_flattening }) = ellipsoid.filter(|it| !is_usual(*it)) {
        let flattening = if inverse_flattening == 0.0 { 0.0 } else { 1.0 / inverse_flattening };
        let squared_eccentricity = flattening * (2.0 - flattening);
        let (sine, cosine) = (libm::sin(latitude.to_radians()), libm::cos(latitude.to_radians()));
        let below = 1.0 - squared_eccentricity * sine * sine;
        let across = semi_major / below.sqrt();
        let along = across * (1.0 - squared_eccentricity) / below;
        return ((across * cosine).to_radians(), along.to_radians());
    }
    let cosine = |multiple: f64| libm::cos(multiple * latitude.to_radians());
    let longitude = 111_412.84 * cosine(1.0) - 93.5 * cosine(3.0) + 0.118 * cosine(5.0);
    let latitude = 111_132.92 - 559.82 * cosine(2.0) + 1.175 * cosine(4.0) - 0.0023 * cosine(6.0);
    (longitude, latitude)
}

/// The same extent in other cells.
fn resample(raster: Raster, size: Size) -> Raster {
    let old = raster.field.size();
    if size == old {
        return raster;
    }
    let across: Vec<Between> = (0..size.columns).map(|x| Between::of(x, old.columns, size.columns)).collect();
    let down: Vec<Between> = (0..size.rows).map(|y| Between::of(y, old.rows, size.rows)).collect();
    let nearest_is_land =
        |x: usize, y: usize| raster.is_valid_at(old.index(across[x].nearest(), down[y].nearest()));
    let valid = raster.valid.as_ref().and_then(|_| {
        let cells = (0..size.cells()).map(|i| nearest_is_land(i % size.columns, i / size.columns));
        Mask::new(size, cells.collect())
    });
    let field = Field::from_function(size, |x, y| {
        if nearest_is_land(x, y) { between(&raster, &across[x], &down[y]) } else { 0.0 }
    });
    Raster { field, valid, ..raster }
}

/// A place between two neighbouring cells along one direction.
struct Between {
    cells: [usize; 2],
    weights: [f64; 2],
}

impl Between {
    /// The centre of new cell `at` of `new`, among `old` cells that span the same extent.
    fn of(at: usize, old: usize, new: usize) -> Self {
        let centre = (at as f64 + 0.5) * old as f64 / new as f64 - 0.5;
        let centre = centre.clamp(0.0, (old - 1) as f64);
        let cell = centre.floor() as usize;
        let share = centre - centre.floor();
        Self { cells: [cell, (cell + 1).min(old - 1)], weights: [1.0 - share, share] }
    }

    fn nearest(&self) -> usize {
        self.cells[usize::from(self.weights[1] > self.weights[0])]
    }
}

/// The mean of four cells, those without data left out and the weights of the others grown to make up for it.
fn between(raster: &Raster, across: &Between, down: &Between) -> f32 {
    let (mut sum, mut whole) = (0.0, 0.0);
    for (y, weight_y) in down.cells.iter().zip(down.weights) {
        for (x, weight_x) in across.cells.iter().zip(across.weights) {
            let index = raster.field.size().index(*x, *y);
            if raster.is_valid_at(index) {
                sum += weight_x * weight_y * f64::from(raster.field.values()[index]);
                whole += weight_x * weight_y;
            }
        }
    }
    (sum / whole) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(field: Field, pixel: [f64; 2], epsg: u32) -> Raster {
        let georeference = Some(Georeference { epsg: Some(epsg), origin: [10.0, 40.0], pixel, keys: None });
        Raster { georeference, ..Raster::from(field) }
    }

    /// A plane that rises by `east` a column and `south` a row.
    fn plane(size: Size, east: f32, south: f32) -> Field {
        Field::from_function(size, |x, y| x as f32 * east + y as f32 * south)
    }

    /// Lengths of a degree at 0° and 45° (National Geospatial-Intelligence Agency, tables for WGS 84).
    #[test]
    fn a_degree_has_its_published_length() {
        for (latitude, longitude_metres, latitude_metres) in
            [(0.0, 111_319.5, 110_574.3), (45.0, 78_846.8, 111_132.1), (60.0, 55_800.0, 111_412.2)]
        {
            let (longitude, along) = metres_per_degree(latitude, None);
            assert!((longitude - longitude_metres).abs() < 0.5, "{latitude}°: {longitude}");
            assert!((along - latitude_metres).abs() < 0.5, "{latitude}°: {along}");
        }
    }

    /// The series and the closed form are the same on the ellipsoid of WGS 84, to some centimetres in 111 km.
    #[test]
    fn the_closed_form_gives_the_lengths_of_the_series() {
        let almost = Ellipsoid::of(6_378_137.0, 298.256).expect("an ellipsoid");
        for latitude in [0.0, 30.0, -45.0, 60.0, 85.0] {
            let (series, closed) =
                (metres_per_degree(latitude, None), metres_per_degree(latitude, Some(almost)));
            let apart = [series.0 - closed.0, series.1 - closed.1];
            assert!(apart.iter().all(|apart| apart.abs() < 0.1), "{latitude}°: {apart:?}");
        }
    }

    /// The Moon is a sphere of 1,737.4 km (IAU 2015), so a degree is 30.32 km; EPSG:4267 is on Clarke's ellipsoid of 1866.
    #[test]
    fn a_degree_is_as_long_as_the_ellipsoid_of_its_planet_makes_it() {
        let moon = Ellipsoid::of(1_737_400.0, 0.0).expect("a sphere");
        let degree = 1_737_400.0 * std::f64::consts::PI / 180.0;
        let lengths = metres_per_degree(60.0, Some(moon));
        assert!((lengths.1 - degree).abs() < 1e-6 && (lengths.0 - 0.5 * degree).abs() < 1e-6, "{lengths:?}");
        let size = Size { columns: 4, rows: 4 };
        let squared_on = |figure: Ellipsoid| {
            let mut raster = placed(plane(size, 1.0, 1.0), [0.01, 0.01], 4326);
            let keys = Some(super::super::geokeys::keys_on(figure));
            raster.georeference = raster.georeference.map(|place| Georeference { epsg: None, keys, ..place });
            let (squared, note) = square(raster).expect("square");
            (squared.cell.expect("square"), note.expect("degrees"))
        };
        let (cell, note) = squared_on(Ellipsoid::of(3_396_190.0, 169.894_447_223_612).expect("Mars"));
        assert!((440.0..470.0).contains(&cell), "{cell}");
        assert!(note.contains("on an ellipsoid of 3396190 m, flattened by 1/169.894"), "{note}");
        let (_, note) = squared_on(moon);
        assert!(note.contains("on a sphere of 1737400 m"), "{note}");
    }

    #[test]
    fn cells_of_less_than_a_millimetre_are_refused() {
        let size = Size { columns: 4, rows: 4 };
        for cell in [None, Some(1e-9)] {
            let raster = Raster { cell, ..placed(plane(size, 1.0, 1.0), [1e-9, 1e-9], 32633) };
            let error = square(raster).expect_err("no landscape").to_string();
            assert!(error.contains("1e-9 m wide, but must be at least 0.001 m"), "{error}");
        }
    }

    #[test]
    fn only_the_coarser_direction_is_resampled_and_the_corners_stay() {
        let size = Size { columns: 40, rows: 30 };
        let (new, note) = square(placed(plane(size, 3.0, 5.0), [0.001, 0.001], 4326)).expect("square");
        let note = note.expect("degrees");
        assert!(
            note.starts_with("degrees became metres at latitude 39.98°: cells of 85.4 × 111.0 m"),
            "{note}"
        );
        assert!(note.ends_with("were resampled to 85.4 m squares, 40 × 39"), "{note}");
        assert_eq!(new.field.size(), Size { columns: 40, rows: 39 });
        let place = new.georeference.expect("kept");
        assert_eq!(place.origin, [10.0, 40.0]);
        assert!((place.pixel[1] * 39.0 - 0.03).abs() < 1e-15 && place.pixel[0] == 0.001);
        assert!((new.cell.expect("metres") - 85.4125).abs() < 0.01, "{:?}", new.cell);
    }

    #[test]
    fn whole_metres_on_a_slope_come_out_as_a_slope_without_steps() {
        let size = Size { columns: 4, rows: 60 };
        let (new, _) = square(placed(plane(size, 0.0, 1.0), [10.0, 17.0], 32633)).expect("square");
        assert_eq!(new.field.size().rows, 102);
        // The first and last rows lie beyond the outermost centres, where there is nothing to go between.
        for y in 1..101 {
            let height = (y as f32 + 0.5) * 60.0 / 102.0 - 0.5;
            assert!(
                (new.field.at(1, y) - height).abs() < 1e-4,
                "row {y}: {} not {height}",
                new.field.at(1, y)
            );
        }
    }

    #[test]
    fn a_new_cell_has_no_data_exactly_where_the_nearest_old_cell_has_none() {
        let size = Size { columns: 3, rows: 20 };
        let mut raster = placed(plane(size, 0.0, 0.0), [1.0, 2.0], 32633);
        raster.field.values_mut().fill(7.0);
        let valid: Vec<bool> = (0..size.cells()).map(|index| index / 3 != 8 && index != 0).collect();
        for (index, _) in valid.iter().enumerate().filter(|(_, valid)| !**valid) {
            raster.field.values_mut()[index] = 0.0;
        }
        raster.valid = Mask::new(size, valid);
        let (new, _) = square(raster).expect("square");
        let valid = new.valid.expect("still without some data");
        for y in 0..40 {
            for x in 0..3 {
                let expected = y / 2 != 8 && (x, y / 2) != (0, 0);
                assert_eq!(valid.is_valid(x, y), expected, "column {x}, row {y}");
                assert_eq!(new.field.at(x, y), if expected { 7.0 } else { 0.0 }, "column {x}, row {y}");
            }
        }
    }

    #[test]
    fn squaring_again_changes_nothing() {
        let size = Size { columns: 40, rows: 30 };
        let (once, _) = square(placed(plane(size, 3.0, 5.0), [0.001, 0.001], 4326)).expect("square");
        let (twice, note) = square(Raster { cell: None, ..once.clone() }).expect("square");
        assert_eq!((twice.field, twice.georeference), (once.field, once.georeference));
        assert!(note.expect("degrees").contains("count as"));
    }

    #[test]
    fn cells_that_cannot_become_square_metres_are_refused() {
        let field = || Field::filled(Size { columns: 2, rows: 2 }, 0.0);
        let unknown = square(Raster::from(field())).expect_err("no cell size");
        assert!(unknown.to_string().contains("give `cell`"), "{unknown}");
        let beyond = square(placed(field(), [1.0, 300.0], 4326)).expect_err("260° south");
        assert!(beyond.to_string().contains("latitude -260°"), "{beyond}");
        let needle = square(placed(field(), [0.001, 1e6], 32633)).expect_err("too many rows");
        assert_eq!(needle.exit_code(), 5);
    }
}
