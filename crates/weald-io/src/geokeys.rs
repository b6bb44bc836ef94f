//! GeoTIFF keys, by which Weald keeps a CRS that its EPSG code alone does not tell, whatever format it came from.
//!
//! Key numbers and codes are those of OGC 19-008r4, annex B.

use super::Fault;
use weald_core::domain::{GeoKeys, Georeference};

const MODEL_TYPE: u16 = 1024;
pub(super) const RASTER_TYPE: u16 = 1025;
const GEOGRAPHIC_TYPE: u16 = 2048;
const PROJECTED_TYPE: u16 = 3072;
const LINEAR_UNITS: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;

const USER_DEFINED: u16 = 32767;
const PROJECTED: u16 = 1;
const GEOGRAPHIC: u16 = 2;
pub(super) const PIXEL_IS_AREA: u16 = 1;
pub(super) const PIXEL_IS_POINT: u16 = 2;
const METRE: u16 = 9001;
const FOOT: u16 = 9002;
const SURVEY_FOOT: u16 = 9003;

/// Where a key says that its value stands among the doubles: the number of their TIFF tag.
pub(super) const DOUBLES: u16 = 34736;

/// Sets a key that stands in the directory itself.
pub(super) fn set_short(keys: &mut GeoKeys, key: u16, value: u16) {
    let entries = keys.directory.get_mut(4..).unwrap_or_default();
    entries.chunks_exact_mut(4).filter(|entry| entry[0] == key).for_each(|entry| entry[3] = value);
}

/// The EPSG code of the CRS, where the keys tell one.
pub(super) fn epsg(keys: &GeoKeys) -> Option<u32> {
    let key = if keys.is_geographic() { GEOGRAPHIC_TYPE } else { PROJECTED_TYPE };
    keys.short(key).filter(|code| (1..USER_DEFINED).contains(code)).map(u32::from)
}

/// Metres in the unit of a projected CRS; 1 where the file names none.
pub(super) fn metres_per_unit(keys: Option<&GeoKeys>) -> Result<f64, Fault> {
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
    let entry = entries.find(|entry| entry[0] == key && entry[1] == DOUBLES)?;
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
pub(super) fn keys_by_code(epsg: Option<u32>, is_geographic: bool, metres: f64) -> GeoKeys {
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
        keys.directory.extend([LINEAR_UNIT_SIZE, DOUBLES, 1, 0]);
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
    fn a_unit_of_the_users_own_has_the_size_that_the_doubles_give() {
        let mut keys = shorts(&[(LINEAR_UNITS, USER_DEFINED)]);
        assert!(metres_per_unit(Some(&keys)).is_err(), "no size");
        keys.directory.extend([LINEAR_UNIT_SIZE, DOUBLES, 1, 1]);
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
