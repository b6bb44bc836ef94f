//! What a user says of a file that does not say it itself: its CRS, the unit of its values, its number for no-data.

use super::Raster;
use super::geokeys::{keys_of_definition, metres_per_unit, tell_a_crs};
use super::unit::{Measure, metres_in};
use super::wkt::{Definition, wkt_of};
use weald_core::domain::Georeference;
use weald_core::error::left_out;
use weald_core::grid::Mask;

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
const MOST_DEGREES: [f64; 2] = [180.0, 90.0];

/// Cells below this side are more likely degrees than metres.
const LIKELY_DEGREES: f64 = 0.01;

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

impl Raster {
    /// What to ask the user where coordinates without a CRS look like degrees: cells below a hundredth that lie where
    /// longitudes and latitudes are.
    pub fn likely_degrees(&self) -> Option<String> {
        let place = self.georeference.as_ref()?;
        let is_told = place.epsg.is_some() || place.keys.as_ref().is_some_and(tell_a_crs);
        let far = place.at([self.field.size().columns as f64, self.field.size().rows as f64]);
        let within =
            |at: [f64; 2]| at.iter().zip(MOST_DEGREES).all(|(at, most)| at.abs() <= most + LIKELY_DEGREES);
        let [width, height] = place.pixel;
        if is_told || width.max(height) >= LIKELY_DEGREES || !within(place.origin) || !within(far) {
            return None;
        }
        let [west, north] = place.origin;
        let metres = format!(", or `cell = {width}` if these are metres");
        let metres = if width >= 0.001 && width == height { metres } else { String::new() };
        Some(format!(
            "it names no CRS, and its cells of {width} × {height} at {west}, {north} look like degrees; say `crs = \
             \"EPSG:4326\"` for longitude and latitude{metres}"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Size};

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
}
