//! What a user says of a file that does not say it itself: its CRS, the unit of its values, its number for no-data.

use super::Raster;
use super::geokeys::{keys_of_definition, metres_per_unit, tell_a_crs};
use super::unit::{Measure, metres_in};
use super::wkt::{Definition, wkt_of};
use weald_core::domain::Georeference;
use weald_core::error::left_out;
use weald_core::grid::{Mask, Size};

/// What is said of a file; nothing by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Said {
    /// EPSG code of the CRS.
    pub crs: Option<u32>,
    /// Unit of the values: a length, or `1` for numbers that are none.
    pub unit: Option<String>,
    /// Number of the cells without data.
    pub no_data: Option<f64>,
}

/// Coordinates below these count as degrees where nothing else is known.
const MOST_DEGREES: [f64; 2] = [360.0, 90.0];

/// Cells below this side are more likely degrees than metres.
const LIKELY_DEGREES: f64 = 0.01;

/// So are any by which ground would rise by this much over a metre on the mean: 84°, where no ground stands.
const TOO_STEEP: f64 = 10.0;

impl Said {
    /// The raster with what is said of it.
    ///
    /// # Errors
    /// A sentence where the file says something else, or where what is said is not known.
    pub fn of(&self, raster: Raster) -> Result<Raster, String> {
        let raster = self.without_data(raster);
        let raster = match &self.unit {
            Some(unit) => in_unit(raster, unit)?,
            None => raster,
        };
        match self.crs {
            Some(code) => in_crs(raster, code),
            None => Ok(raster),
        }
    }

    fn without_data(&self, mut raster: Raster) -> Raster {
        let Some(none) = self.no_data else { return raster };
        let size = raster.field.size();
        let has_data = |(index, value): (usize, &f32)| raster.is_valid_at(index) && *value != none as f32;
        let valid: Vec<bool> = raster.field.values().iter().enumerate().map(has_data).collect();
        for (value, valid) in raster.field.values_mut().iter_mut().zip(&valid) {
            *value = if *valid { *value } else { 0.0 };
        }
        Raster { valid: Mask::new(size, valid), ..raster }
    }
}

fn in_unit(mut raster: Raster, unit: &str) -> Result<Raster, String> {
    let metres = metres_in(unit);
    if raster.unit() == Some("m") && metres != Some(1.0) {
        return Err(format!("its values are in metres, or were brought to them; remove `unit = \"{unit}\"`"));
    }
    if metres.is_none() && unit != "1" {
        return Err(format!("`unit = \"{unit}\"` is no length that is known, such as m, ft or us-ft"));
    }
    let measure = Measure::new(1.0, 0.0, Some(unit));
    for value in raster.field.values_mut() {
        *value = measure.value(f64::from(*value));
    }
    raster.notes.extend(measure.notes());
    // The unit that is said counts, and no more that of the file.
    Ok(Raster { unit: measure.unit(), provenance: None, ..raster })
}

fn in_crs(raster: Raster, code: u32) -> Result<Raster, String> {
    let Some(place) = &raster.georeference else {
        return Err(format!(
            "it has no coordinates, so `crs = \"EPSG:{code}\"` says nothing of it; remove `crs`"
        ));
    };
    if place.epsg == Some(code) {
        return Ok(raster);
    }
    if place.epsg.is_some() || place.keys.as_ref().is_some_and(tell_a_crs) {
        let known = place.epsg.map_or("a CRS without a code".to_owned(), |code| format!("EPSG:{code}"));
        return Err(format!(
            "it is in {known} already; remove `crs`, or warp it: gdalwarp -t_srs EPSG:{code}"
        ));
    }
    if !cfg!(feature = "wkt") {
        return Err(format!("`crs = \"EPSG:{code}\"`: {}", left_out("the definitions of CRSs", "wkt")));
    }
    let unknown = || format!("EPSG:{code} is not known as a CRS; look it up on epsg.io");
    let definition = wkt_of(code).and_then(Definition::of).ok_or_else(unknown)?;
    let keys = keys_of_definition(&definition).map_err(|fault| format!("EPSG:{code}: {fault}"))?;
    let metres = metres_per_unit(Some(&keys)).map_err(|fault| fault.to_string())?;
    let place = Georeference { epsg: Some(code), keys: Some(keys), ..place.clone() };
    let is_square = (place.pixel[0] - place.pixel[1]).abs() <= 1e-9 * place.pixel[0];
    let cell = (is_square && !place.is_geographic()).then_some(place.pixel[0] * metres);
    Ok(Raster { cell, georeference: Some(place), ..raster })
}

/// Whether a raster of that size and place without a CRS lies where longitudes and latitudes do.
fn may_be_degrees(place: &Georeference, size: Size) -> bool {
    let is_told = place.epsg.is_some() || place.keys.as_ref().is_some_and(tell_a_crs);
    let far = place.at([size.columns as f64, size.rows as f64]);
    let within =
        |at: [f64; 2]| at.iter().zip(MOST_DEGREES).all(|(at, most)| at.abs() <= most + LIKELY_DEGREES);
    !is_told && within(place.origin) && within(far)
}

impl Raster {
    /// What to ask the user where coordinates without a CRS look like degrees: they lie where longitudes and latitudes are, and
    /// cells are below a hundredth, or the ground would be steeper than any if they were metres.
    pub fn likely_degrees(&self) -> Option<String> {
        let place = self.georeference.as_ref()?;
        if !may_be_degrees(place, self.field.size()) {
            return None;
        }
        let [width, height] = place.pixel;
        let is_fine = width.max(height) < LIKELY_DEGREES;
        // What Weald wrote without a CRS is in metres, and may be as steep as it was asked for.
        let steepness = if self.provenance.is_some() { 0.0 } else { self.steepness(width) };
        if !is_fine && steepness < TOO_STEEP {
            return None;
        }
        let [west, north] = place.origin;
        let metres = format!(", or `cell = {width}` if these are metres");
        let metres = if width >= 0.001 && width == height { metres } else { String::new() };
        let slope =
            format!(" (in metres, its ground would stand at {:.1}°)", libm::atan(steepness).to_degrees());
        let slope = if is_fine { String::new() } else { slope };
        Some(format!(
            "it names no CRS, and its cells of {width} × {height} at {west}, {north} look like degrees{slope}; say `crs = \
             \"EPSG:4326\"` for longitude and latitude{metres}"
        ))
    }

    /// What to ask of rows of a raster of that size: that of [`Raster::likely_degrees`] but where steepness would tell, of which
    /// rows do not know enough.
    pub fn possible_degrees(&self, whole: Size) -> Option<String> {
        let place = self.georeference.as_ref()?;
        let [width, height] = place.pixel;
        let is_told = self.provenance.is_some() && width.max(height) >= LIKELY_DEGREES;
        (may_be_degrees(place, whole) && !is_told).then(|| {
            format!(
                "it names no CRS, and its cells of {width} × {height} may be degrees; say `crs = \"EPSG:4326\"` for longitude \
                 and latitude, or `cell = {width}` if these are metres"
            )
        })
    }

    /// Mean rise from cell to cell over their width.
    fn steepness(&self, width: f64) -> f64 {
        let (columns, values) = (self.field.size().columns, self.field.values());
        let has_data = |cell: &usize| self.is_valid_at(*cell) && self.is_valid_at(*cell + 1);
        let pairs = (0..values.len().saturating_sub(1)).filter(|cell| (cell + 1) % columns > 0);
        let rises = pairs.filter(has_data).map(|cell| f64::from((values[cell + 1] - values[cell]).abs()));
        let (sum, count) = rises.fold((0.0, 0_usize), |(sum, count), rise| (sum + rise, count + 1));
        sum / count.max(1) as f64 / width
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Field;

    fn raster(pixel: f64, origin: [f64; 2]) -> Raster {
        let size = Size { columns: 3, rows: 2 };
        let georeference = Some(Georeference { epsg: None, origin, pixel: [pixel; 2], keys: None });
        let field = Field::from_function(size, |x, y| (x + 3 * y) as f32);
        Raster { georeference, cell: Some(pixel), ..Raster::from(field) }
    }

    #[test]
    fn the_number_said_to_be_no_data_is_none_and_feet_become_metres() {
        let said = Said { unit: Some("ft".to_owned()), no_data: Some(4.0), ..Said::default() };
        let raster = said.of(raster(5.0, [0.0; 2])).expect("fits");
        assert_eq!(raster.field.values(), [0.0, 0.3048, 0.6096, 0.9144, 0.0, 1.524]);
        assert_eq!(raster.valid.as_ref().map(|valid| valid.is_valid(1, 1)), Some(false));
        assert_eq!(raster.unit.as_deref(), Some("m"));
        let again = said.of(raster).expect_err("metres already");
        assert!(again.contains("remove `unit = \"ft\"`"), "{again}");
    }

    #[test]
    #[cfg(feature = "wkt")]
    fn a_crs_said_brings_degrees_feet_and_its_ellipsoid() {
        let said = |crs| Said { crs: Some(crs), ..Said::default() };
        let degrees = said(4326).of(raster(0.001, [10.0, 40.0])).expect("placed");
        assert!(
            degrees.cell.is_none() && degrees.georeference.as_ref().is_some_and(Georeference::is_geographic)
        );
        let feet = said(2264).of(raster(10.0, [2e6, 6e5])).expect("placed");
        assert!((feet.cell.expect("square") - 3.048_006).abs() < 1e-6);
        let error = said(32633).of(degrees).expect_err("another");
        assert!(error.contains("EPSG:4326 already"), "{error}");
        for (code, words) in [(4978, "geocentric"), (4807, "not in degrees"), (1, "not known")] {
            let error = said(code).of(raster(1.0, [10.0, 40.0])).expect_err("no map");
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn small_cells_where_degrees_are_look_like_degrees_without_a_crs() {
        let question = raster(1.0 / 1200.0, [-84.4, 36.7]).likely_degrees().expect("degrees");
        assert!(question.contains("say `crs = \"EPSG:4326\"`") && !question.contains("cell ="), "{question}");
        let question = raster(0.005, [10.0, 40.0]).likely_degrees().expect("degrees");
        assert!(question.contains("`cell = 0.005` if these are metres"), "{question}");
        assert_eq!(raster(0.5, [10.0, 40.0]).likely_degrees(), None);
        assert_eq!(raster(0.005, [500_000.0, 40.0]).likely_degrees(), None);
        let mut told = raster(0.005, [10.0, 40.0]);
        told.georeference.as_mut().expect("placed").epsg = Some(32633);
        assert_eq!(told.likely_degrees(), None);
    }

    #[test]
    fn ground_that_no_metres_could_hold_looks_like_degrees_whatever_its_cells() {
        let mountains = |side: f64, origin: [f64; 2]| {
            let mut raster = raster(side, origin);
            raster
                .field
                .values_mut()
                .iter_mut()
                .enumerate()
                .for_each(|(at, height)| *height = [300.0, 420.0, 360.0][at % 3]);
            raster
        };
        for (side, origin) in [(0.1, [5.0, 48.0]), (0.25, [350.0, 90.0]), (2.0, [-180.0, 10.0])] {
            let question = mountains(side, origin).likely_degrees().expect("degrees");
            assert!(
                question.contains("its ground would stand at 8")
                    && question.contains(&format!("cell = {side}"))
            );
        }
        assert_eq!(mountains(0.1, [5000.0, 48.0]).likely_degrees(), None, "no longitude");
        assert_eq!(mountains(30.0, [0.0, 60.0]).likely_degrees(), None, "a steep slope");
        let valid = Mask::new(Size { columns: 3, rows: 2 }, vec![true, false, true, false, true, false]);
        let sparse = Raster { valid, ..mountains(0.1, [5.0, 48.0]) };
        assert_eq!(sparse.likely_degrees(), None, "no two cells beside each other");
    }
}
