//! GeoTIFF keys, by which Weald keeps a CRS that its EPSG code alone does not tell, whatever format it came from.
//!
//! Key numbers and codes are those of OGC 19-008r4, annex B.

use super::Fault;
use super::unit::{FOOT, SURVEY_FOOT, name_of};
use super::wkt::{self, Definition, Ellipsoid, Kind};
use weald_core::domain::{GeoKeys, Georeference};

const MODEL_TYPE: u16 = 1024;
pub(super) const RASTER_TYPE: u16 = 1025;
const GEOGRAPHIC_TYPE: u16 = 2048;
const ANGULAR_UNITS: u16 = 2054;
const ELLIPSOID: u16 = 2056;
const SEMI_MAJOR_AXIS: u16 = 2057;
const SEMI_MINOR_AXIS: u16 = 2058;
const INVERSE_FLATTENING: u16 = 2059;
const PROJECTED_TYPE: u16 = 3072;
const LINEAR_UNITS: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;
const VERTICAL_TYPE: u16 = 4096;
const VERTICAL_UNITS: u16 = 4099;

const USER_DEFINED: u16 = 32767;
const PROJECTED: u16 = 1;
const GEOGRAPHIC: u16 = 2;
const GEOCENTRIC: u16 = 3;
pub(super) const PIXEL_IS_AREA: u16 = 1;
pub(super) const PIXEL_IS_POINT: u16 = 2;
/// Codes of units and their metres.
const LENGTHS: [(u16, f64); 3] = [(METRE, 1.0), (9002, FOOT), (9003, SURVEY_FOOT)];
const METRE: u16 = 9001;
/// A degree, and a degree by its supplier.
const DEGREES: [u16; 2] = [9102, 9122];

/// Where a key says that its value stands among the doubles: the number of their TIFF tag.
pub(super) const DOUBLES: u16 = 34736;

/// Sets a key that stands in the directory itself.
pub(super) fn set_short(keys: &mut GeoKeys, key: u16, value: u16) {
    let entries = keys.directory.get_mut(4..).unwrap_or_default();
    entries.chunks_exact_mut(4).filter(|entry| entry[0] == key).for_each(|entry| entry[3] = value);
}

/// The EPSG code of the CRS, where the keys tell one and count in its unit.
pub(super) fn epsg(keys: &GeoKeys) -> Option<u32> {
    let is_its_unit = |code: &u32| match linear_unit(keys) {
        Ok(Some(metres)) => metres_of(*code).is_none_or(|of_code| (metres / of_code - 1.0).abs() < 1e-6),
        _ => true,
    };
    code(keys).filter(is_its_unit)
}

fn code(keys: &GeoKeys) -> Option<u32> {
    let key = if keys.is_geographic() { GEOGRAPHIC_TYPE } else { PROJECTED_TYPE };
    keys.short(key).filter(|code| (1..USER_DEFINED).contains(code)).map(u32::from)
}

/// Metres in the unit of the projected CRS of a code.
fn metres_of(code: u32) -> Option<f64> {
    wkt::wkt_of(code).and_then(Definition::of)?.metres.map(rounded)
}

/// Whether the keys say what the coordinates are.
pub(super) fn tell_a_crs(keys: &GeoKeys) -> bool {
    keys.short(MODEL_TYPE).is_some_and(|model| [PROJECTED, GEOGRAPHIC].contains(&model))
}

/// Refuses coordinates that are neither lengths on a map nor degrees.
pub(super) fn ensure_mapped(keys: &GeoKeys) -> Result<(), Fault> {
    let to_degrees = "gdalwarp -t_srs EPSG:4326";
    if keys.short(MODEL_TYPE) == Some(GEOCENTRIC) {
        return Err(Fault::damaged(format!(
            "the CRS is geocentric: its coordinates go from the centre of the Earth, not along its surface: {to_degrees}"
        )));
    }
    let definition = || wkt::wkt_of(code(keys)?).and_then(Definition::of);
    let is_in_degrees = match keys.short(ANGULAR_UNITS) {
        None | Some(0) => !keys.is_geographic() || definition().is_none_or(|it| it.is_in_degrees),
        Some(unit) => !keys.is_geographic() || DEGREES.contains(&unit),
    };
    if is_in_degrees {
        return Ok(());
    }
    let unit =
        keys.short(ANGULAR_UNITS).map_or_else(String::new, |unit| format!(", but in unit {unit} of EPSG"));
    Err(Fault::damaged(format!("the CRS counts angles not in degrees{unit}; degrees are read: {to_degrees}")))
}

/// Metres in the unit of a projected CRS, by the keys or by its code; 1 where neither names one.
pub(super) fn metres_per_unit(keys: Option<&GeoKeys>) -> Result<f64, Fault> {
    let Some(keys) = keys else { return Ok(1.0) };
    Ok(match linear_unit(keys)? {
        Some(metres) => metres,
        None if keys.is_geographic() => 1.0,
        None => code(keys).and_then(metres_of).unwrap_or(1.0),
    })
}

/// Metres in the unit that the keys themselves name.
fn linear_unit(keys: &GeoKeys) -> Result<Option<f64>, Fault> {
    match keys.short(LINEAR_UNITS) {
        None | Some(0) => Ok(None),
        Some(USER_DEFINED) => double(keys, LINEAR_UNIT_SIZE)
            .filter(|metres| *metres > 0.0 && metres.is_finite())
            .map(Some)
            .ok_or_else(|| Fault::damaged("the linear unit is user-defined, but key 3077 gives no size")),
        Some(unit) => {
            let known = LENGTHS.iter().find(|(code, _)| *code == unit).map(|(_, metres)| Some(*metres));
            known.ok_or_else(|| {
                Fault::damaged(format!(
                    "linear unit {unit}; 9001 (metre), 9002 and 9003 (feet) are read: gdalwarp to a CRS in metres"
                ))
            })
        }
    }
}

/// A length with all its digits: texts cut those of the survey foot off.
pub(super) fn rounded(metres: f64) -> f64 {
    let near = |(_, known): &&(u16, f64)| (metres / known - 1.0).abs() < 1e-8;
    LENGTHS.iter().find(near).map_or(metres, |(_, known)| *known)
}

/// The unit of the heights by the keys; one that Weald does not know is called by its code.
pub(super) fn vertical_unit(keys: &GeoKeys) -> Option<String> {
    let is_told = |code: &u16| ![0, USER_DEFINED].contains(code);
    if let Some(unit) = keys.short(VERTICAL_UNITS).filter(is_told) {
        let known = LENGTHS.iter().find(|(code, _)| *code == unit);
        return Some(known.map_or_else(|| format!("unit {unit} of EPSG"), |(_, metres)| name_of(*metres)));
    }
    let code = keys.short(VERTICAL_TYPE).filter(is_told)?;
    let metres = wkt::definition_with("VERT_CS", code).and_then(|definition| definition.vertical);
    Some(metres.map_or_else(|| format!("the unit of EPSG:{code}"), |metres| name_of(rounded(metres))))
}

/// The ellipsoid of a place, by its keys or by its codes.
pub(super) fn ellipsoid(place: &Georeference) -> Option<Ellipsoid> {
    let keys = place.keys.as_ref();
    let number = |key: u16| double(keys?, key);
    let flattening = |minor: f64, major: f64| if major == minor { 0.0 } else { major / (major - minor) };
    let own = number(SEMI_MAJOR_AXIS).and_then(|major| {
        let by_minor = || number(SEMI_MINOR_AXIS).map(|minor| flattening(minor, major));
        Ellipsoid::of(major, number(INVERSE_FLATTENING).or_else(by_minor)?)
    });
    let by_code = || wkt::wkt_of(place.epsg?).and_then(Definition::of)?.ellipsoid;
    let by_own_code = || {
        let code = keys?.short(ELLIPSOID).filter(|code| ![0, USER_DEFINED].contains(code))?;
        wkt::definition_with("SPHEROID", code)?.ellipsoid
    };
    own.or_else(by_code).or_else(by_own_code)
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

/// The keys of a CRS: longitude and latitude, or a grid in a unit of so many metres.
pub(super) fn keys_by_code(epsg: Option<u32>, is_geographic: bool, metres: f64) -> GeoKeys {
    let code = epsg.and_then(|code| u16::try_from(code).ok()).unwrap_or(USER_DEFINED);
    if is_geographic {
        return shorts(&[(MODEL_TYPE, GEOGRAPHIC), (RASTER_TYPE, PIXEL_IS_AREA), (GEOGRAPHIC_TYPE, code)]);
    }
    let named = LENGTHS.iter().find(|(_, known)| *known == metres).map(|(code, _)| *code);
    let unit = (LINEAR_UNITS, named.unwrap_or(USER_DEFINED));
    let mut keys =
        shorts(&[(MODEL_TYPE, PROJECTED), (RASTER_TYPE, PIXEL_IS_AREA), (PROJECTED_TYPE, code), unit]);
    if named.is_none() {
        add_double(&mut keys, LINEAR_UNIT_SIZE, metres);
    }
    keys
}

/// The keys of longitude and latitude on an ellipsoid that no code tells.
pub(super) fn keys_on(ellipsoid: Ellipsoid) -> GeoKeys {
    let mut keys = keys_by_code(None, true, 1.0);
    keys.directory[3] += 1;
    keys.directory.extend([ELLIPSOID, 0, 1, USER_DEFINED]);
    add_double(&mut keys, SEMI_MAJOR_AXIS, ellipsoid.semi_major);
    add_double(&mut keys, INVERSE_FLATTENING, ellipsoid.inverse_flattening);
    keys
}

/// The keys of a CRS by its definition, and its code.
///
/// # Errors
/// [`Fault::Damaged`] for coordinates that are neither lengths on a map nor degrees.
pub(super) fn keys_of_definition(definition: &Definition) -> Result<GeoKeys, Fault> {
    let keys = match (definition.kind, definition.epsg, definition.ellipsoid) {
        (Kind::Geographic, None, Some(ellipsoid)) => keys_on(ellipsoid),
        (Kind::Geographic, epsg, _) => keys_by_code(epsg, true, 1.0),
        (Kind::Geocentric, ..) => shorts(&[(MODEL_TYPE, GEOCENTRIC)]),
        (_, epsg, _) => keys_by_code(epsg, false, definition.metres.map_or(1.0, rounded)),
    };
    if definition.kind == Kind::Geographic && !definition.is_in_degrees {
        return Err(Fault::damaged(
            "the CRS counts angles not in degrees; degrees are read: gdalwarp -t_srs EPSG:4326",
        ));
    }
    ensure_mapped(&keys).map(|()| keys)
}

fn add_double(keys: &mut GeoKeys, key: u16, number: f64) {
    keys.directory[3] += 1;
    keys.directory.extend([key, DOUBLES, 1, keys.doubles.len() as u16]);
    keys.doubles.push(number);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_a_unit_give_its_metres_again() {
        for metres in [1.0, 0.3048, 1200.0 / 3937.0, 201.168] {
            let keys = keys_by_code(Some(2264), false, metres);
            assert_eq!(metres_per_unit(Some(&keys)), Ok(metres));
            let is_of_code = metres == 1200.0 / 3937.0 || !cfg!(feature = "wkt");
            assert_eq!((epsg(&keys), keys.is_geographic()), (is_of_code.then_some(2264), false), "{metres}");
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
