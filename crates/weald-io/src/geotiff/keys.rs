//! Place on Earth: the GeoTIFF keys, the pixel scale and the tie point.
//!
//! Key numbers and codes are those of OGC 19-008r4, annex B.

use super::super::Fault;
use super::directory::Directory;
use super::tag;
use weald_core::domain::{GeoKeys, Georeference};

const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const GEOGRAPHIC_TYPE: u16 = 2048;
const PROJECTED_TYPE: u16 = 3072;
const LINEAR_UNITS: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;

const USER_DEFINED: u16 = 32767;
const PROJECTED: u16 = 1;
const GEOGRAPHIC: u16 = 2;
const PIXEL_IS_AREA: u16 = 1;
const PIXEL_IS_POINT: u16 = 2;
const METRE: u16 = 9001;
const FOOT: u16 = 9002;
const SURVEY_FOOT: u16 = 9003;

/// Sides of a cell may differ by this share and still be called square: what decimal digits lose.
const SQUARE: f64 = 1e-9;

/// What a file says about its place.
#[derive(Debug)]
pub(super) struct Place {
    /// Side of the cells in metres, where they are square and not in degrees.
    pub(super) cell: Option<f64>,
    pub(super) georeference: Option<Georeference>,
}

/// Where the cells of a file lie.
pub(super) fn place(directory: &Directory<'_>) -> Result<Place, Fault> {
    let Some((mut origin, pixel)) = corner_and_pixel(directory)? else {
        return Ok(Place { cell: None, georeference: None });
    };
    let mut keys = keys_of(directory)?;
    if let Some(keys) = &mut keys
        && keys.short(RASTER_TYPE) == Some(PIXEL_IS_POINT)
    {
        // The tie point is the centre of its cell; Weald and most software count from the corner.
        origin = [origin[0] - 0.5 * pixel[0], origin[1] + 0.5 * pixel[1]];
        set_short(keys, RASTER_TYPE, PIXEL_IS_AREA);
    }
    let metres = metres_per_unit(keys.as_ref())?;
    let georeference = Georeference { epsg: keys.as_ref().and_then(epsg), origin, pixel, keys };
    let square = (pixel[0] - pixel[1]).abs() <= SQUARE * pixel[0];
    let cell = (square && !georeference.is_geographic()).then_some(pixel[0] * metres);
    Ok(Place { cell, georeference: Some(georeference) })
}

/// North-western corner and sides of the cells, in CRS units.
type CornerAndPixel = ([f64; 2], [f64; 2]);

fn corner_and_pixel(directory: &Directory<'_>) -> Result<Option<CornerAndPixel>, Fault> {
    if let Some(matrix) = directory.doubles(tag::MODEL_TRANSFORMATION)? {
        return from_matrix(&matrix).map(Some);
    }
    let tie = directory.doubles(tag::MODEL_TIE_POINT)?.unwrap_or_default();
    match (directory.doubles(tag::MODEL_PIXEL_SCALE)?.as_deref(), tie.as_slice()) {
        (None, []) => Ok(None),
        (Some([width, height, ..]), [column, row, _, x, y, _]) => {
            checked([x - column * width, y + row * height], [*width, *height]).map(Some)
        }
        (scale, tie) => Err(Fault::damaged(format!(
            "{} numbers of pixel scale and {} of tie points place the file; one tie point of 6 numbers with a \
             scale of 3 is read: rectify control points with gdalwarp",
            scale.map_or(0, <[f64]>::len),
            tie.len()
        ))),
    }
}

fn from_matrix(matrix: &[f64]) -> Result<CornerAndPixel, Fault> {
    let &[width, shear_x, _, x, shear_y, minus_height, _, y, ..] = matrix else {
        return Err(Fault::damaged(format!("a model transformation of {} numbers, not 16", matrix.len())));
    };
    if shear_x != 0.0 || shear_y != 0.0 {
        return Err(Fault::damaged(format!(
            "the grid is rotated or sheared (model transformation terms {shear_x} and {shear_y}); turn it north \
             with gdalwarp"
        )));
    }
    checked([x, y], [width, -minus_height])
}

fn checked(origin: [f64; 2], pixel: [f64; 2]) -> Result<CornerAndPixel, Fault> {
    let positive = pixel.iter().all(|side| *side > 0.0 && side.is_finite());
    if positive && origin.iter().all(|coordinate| coordinate.is_finite()) {
        return Ok((origin, pixel));
    }
    Err(Fault::damaged(format!(
        "cells of {} × {} at {}, {}; sides must be above 0 with rows from north to south: gdalwarp rectifies",
        pixel[0], pixel[1], origin[0], origin[1]
    )))
}

fn keys_of(directory: &Directory<'_>) -> Result<Option<GeoKeys>, Fault> {
    let Some(numbers) = directory.numbers(tag::GEO_KEY_DIRECTORY)? else { return Ok(None) };
    let ascii = directory.text(tag::GEO_ASCII_PARAMETERS)?.unwrap_or_default();
    Ok(Some(GeoKeys {
        directory: numbers.into_iter().map(|number| number as u16).collect(),
        doubles: directory.doubles(tag::GEO_DOUBLE_PARAMETERS)?.unwrap_or_default(),
        // One character a byte, as the keys count bytes; the standard allows 7-bit ASCII alone.
        ascii: ascii.iter().map(|&byte| if byte.is_ascii() { byte as char } else { '?' }).collect(),
    }))
}

fn set_short(keys: &mut GeoKeys, key: u16, value: u16) {
    let entries = keys.directory.get_mut(4..).unwrap_or_default();
    entries.chunks_exact_mut(4).filter(|entry| entry[0] == key).for_each(|entry| entry[3] = value);
}

fn epsg(keys: &GeoKeys) -> Option<u32> {
    let key = if keys.is_geographic() { GEOGRAPHIC_TYPE } else { PROJECTED_TYPE };
    keys.short(key).filter(|code| (1..USER_DEFINED).contains(code)).map(u32::from)
}

/// Metres in the unit of a projected CRS; 1 where the file names none.
pub(crate) fn metres_per_unit(keys: Option<&GeoKeys>) -> Result<f64, Fault> {
    let Some(keys) = keys else { return Ok(1.0) };
    match keys.short(LINEAR_UNITS) {
        None | Some(0 | METRE) => Ok(1.0),
        Some(FOOT) => Ok(0.3048),
        Some(SURVEY_FOOT) => Ok(1200.0 / 3937.0),
        Some(USER_DEFINED) => double(keys, LINEAR_UNIT_SIZE)
            .filter(|metres| *metres > 0.0 && metres.is_finite())
            .ok_or_else(|| Fault::damaged("the linear unit is user-defined, but key 3077 gives no size")),
        Some(unit) => Err(Fault::damaged(format!(
            "linear unit {unit}; {METRE} (metre), {FOOT} and {SURVEY_FOOT} (feet) are read: gdalwarp to a CRS \
             in metres"
        ))),
    }
}

/// The value of a key that is stored among the doubles.
fn double(keys: &GeoKeys, key: u16) -> Option<f64> {
    let mut entries = keys.directory.get(4..)?.chunks_exact(4);
    let entry = entries.find(|entry| entry[0] == key && entry[1] == tag::GEO_DOUBLE_PARAMETERS)?;
    keys.doubles.get(usize::from(entry[3])).copied()
}

/// The keys to write: as they were read, or made for the EPSG code; `None` for a grid without a CRS.
pub(super) fn keys_for(place: &Georeference) -> Option<GeoKeys> {
    let made = || {
        let code = u16::try_from(place.epsg?).ok()?;
        let (model, key) =
            if place.is_geographic() { (GEOGRAPHIC, GEOGRAPHIC_TYPE) } else { (PROJECTED, PROJECTED_TYPE) };
        Some(shorts(&[(MODEL_TYPE, model), (RASTER_TYPE, PIXEL_IS_AREA), (key, code)]))
    };
    place.keys.clone().or_else(made)
}

fn shorts(keys: &[(u16, u16)]) -> GeoKeys {
    let header = [1, 1, 0, keys.len() as u16];
    let entries = keys.iter().flat_map(|&(key, value)| [key, 0, 1, value]);
    GeoKeys { directory: header.into_iter().chain(entries).collect(), ..GeoKeys::default() }
}

/// The keys of a CRS by its code alone: longitude and latitude, or a grid in a unit of so many metres.
pub(crate) fn keys_by_code(epsg: Option<u32>, is_geographic: bool, metres: f64) -> GeoKeys {
    let code = epsg.and_then(|code| u16::try_from(code).ok()).unwrap_or(USER_DEFINED);
    if is_geographic {
        return shorts(&[(MODEL_TYPE, GEOGRAPHIC), (RASTER_TYPE, PIXEL_IS_AREA), (GEOGRAPHIC_TYPE, code)]);
    }
    let named = [METRE, FOOT, SURVEY_FOOT].into_iter().find(|unit| {
        let keys = shorts(&[(LINEAR_UNITS, *unit)]);
        metres_per_unit(Some(&keys)) == Ok(metres)
    });
    let unit = (LINEAR_UNITS, named.unwrap_or(USER_DEFINED));
    let mut keys =
        shorts(&[(MODEL_TYPE, PROJECTED), (RASTER_TYPE, PIXEL_IS_AREA), (PROJECTED_TYPE, code), unit]);
    if named.is_none() {
        keys.directory[3] += 1;
        keys.directory.extend([LINEAR_UNIT_SIZE, tag::GEO_DOUBLE_PARAMETERS, 1, 0]);
        keys.doubles = vec![metres];
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_a_unit_give_its_metres_again() {
        for metres in [1.0, 0.3048, 1200.0 / 3937.0, 201.168] {
            let keys = keys_by_code(Some(2264), false, metres);
            assert_eq!(metres_per_unit(Some(&keys)), Ok(metres));
            assert_eq!((epsg(&keys), keys.is_geographic()), (Some(2264), false));
            assert_eq!(keys.directory.len(), 4 + 4 * usize::from(keys.directory[3]));
        }
        assert!(keys_by_code(None, true, 1.0).is_geographic());
    }

    #[test]
    fn a_matrix_without_rotation_is_a_corner_and_a_cell() {
        let mut matrix = [0.0; 16];
        (matrix[0], matrix[3], matrix[5], matrix[7]) = (30.0, 500.0, -20.0, 900.0);
        assert_eq!(from_matrix(&matrix), Ok(([500.0, 900.0], [30.0, 20.0])));
        matrix[1] = 1e-3;
        assert!(from_matrix(&matrix).is_err_and(|fault| fault.to_string().contains("gdalwarp")));
        assert!(from_matrix(&matrix[..4]).is_err());
    }

    #[test]
    fn cells_without_a_size_or_a_place_are_refused() {
        for (origin, pixel) in [
            ([0.0, 0.0], [0.0, 1.0]),
            ([0.0, 0.0], [1.0, -1.0]),
            ([0.0, 0.0], [f64::NAN, 1.0]),
            ([0.0, 0.0], [1.0, f64::INFINITY]),
            ([f64::NAN, 0.0], [1.0, 1.0]),
        ] {
            assert!(checked(origin, pixel).is_err(), "cells of {pixel:?} at {origin:?}");
        }
    }

    #[test]
    fn a_unit_of_the_users_own_has_the_size_that_the_doubles_give() {
        let mut keys = shorts(&[(LINEAR_UNITS, USER_DEFINED)]);
        assert!(metres_per_unit(Some(&keys)).is_err(), "no size");
        keys.directory.extend([LINEAR_UNIT_SIZE, tag::GEO_DOUBLE_PARAMETERS, 1, 1]);
        keys.doubles = vec![6.0, 201.168];
        assert_eq!(metres_per_unit(Some(&keys)), Ok(201.168));
        assert!(metres_per_unit(Some(&shorts(&[(LINEAR_UNITS, 9036)]))).is_err(), "kilometres");
    }

    #[test]
    fn an_epsg_code_alone_becomes_keys_of_its_kind() {
        let place = |epsg| Georeference { epsg, origin: [0.0; 2], pixel: [1.0; 2], keys: None };
        let keys = keys_for(&place(Some(4326))).expect("a code");
        assert_eq!((keys.short(GEOGRAPHIC_TYPE), keys.short(PROJECTED_TYPE)), (Some(4326), None));
        let keys = keys_for(&place(Some(32616))).expect("a code");
        assert_eq!((keys.short(GEOGRAPHIC_TYPE), keys.short(PROJECTED_TYPE)), (None, Some(32616)));
        assert_eq!(epsg(&keys), Some(32616));
        assert_eq!(keys_for(&place(None)), None);
    }
}
