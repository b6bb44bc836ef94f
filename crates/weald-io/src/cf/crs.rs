//! The coordinate reference system: attributes of `spatial_ref` and of the axes, written and read.

use super::super::geokeys::{
    ensure_mapped, keys_by_code, keys_of_definition, keys_on, metres_per_unit, rounded,
};
use super::super::unit::{metres_in, name_of};
use super::super::wkt::{Definition, Ellipsoid, Kind, wkt_of};
use super::super::{CrsSupport, Fault, Metadata};
use super::attribute::{Attribute, Attributes};
use super::axis::Axis;
use super::{GEO_TRANSFORM, mapping};
use weald_core::domain::{GeoKeys, Georeference};

/// Attributes with the `GeoTIFF` keys of a raster that came from such a file.
const KEYS: [&str; 3] = ["GeoKeyDirectory", "GeoDoubleParams", "GeoAsciiParams"];

/// What the user is informed of another CRS.
pub const OMITTED_CRS_NOTE: &str = if cfg!(feature = "wkt") {
    "the CRS has no EPSG code with a definition, so that only Weald finds it; .tif holds it for all"
} else {
    "WKT of a CRS is not part of this build, so that only Weald finds the CRS; build with the feature `wkt`, or write \
     .tif, which holds it for all"
};

/// The CRSs that only Weald finds.
pub(crate) const OMITTED_CRS: Metadata =
    Metadata::Crs(CrsSupport { supports: is_readable_by_all, loss: OMITTED_CRS_NOTE });

/// Whether other programs find the CRS in a file of arrays: it has an EPSG code with a known definition.
pub fn is_readable_by_all(place: &Georeference) -> bool {
    place.epsg.is_some_and(|code| wkt_of(code).is_some())
}

/// The attributes of the variable `spatial_ref`.
pub(super) fn attributes(place: &Georeference) -> Attributes {
    let mut attributes = Attributes::default();
    if let Some(code) = place.epsg {
        let wkt = wkt_of(code);
        attributes.0.extend(wkt.and_then(mapping::cf_attributes).unwrap_or_default().0);
        for (name, wkt) in ["crs_wkt", "spatial_ref"].into_iter().zip(wkt.into_iter().cycle()) {
            attributes.add(name, wkt);
        }
        attributes.add("epsg_code", format!("EPSG:{code}"));
    }
    let ([west, north], [width, height]) = (place.origin, place.pixel);
    attributes.add(GEO_TRANSFORM, format!("{west:?} {width:?} 0 {north:?} 0 {:?}", -height));
    if let Some(keys) = &place.keys {
        let directory = keys.directory.iter().map(|&number| i32::from(number)).collect();
        attributes.0.push((KEYS[0].to_owned(), Attribute::Integers(directory)));
        attributes.0.push((KEYS[1].to_owned(), Attribute::Doubles(keys.doubles.clone())));
        attributes.add(KEYS[2], keys.ascii.as_str());
    }
    attributes
}

/// The attributes of a coordinate.
pub(super) fn axis_attributes(axis: Axis, place: Option<&Georeference>) -> Attributes {
    let is_geographic = place.is_some_and(Georeference::is_geographic);
    let (letter, standard, long) = match (axis, is_geographic) {
        (Axis::X, false) => ("X", "projection_x_coordinate", "easting of the centre of the cell"),
        (Axis::Y, false) => ("Y", "projection_y_coordinate", "northing of the centre of the cell"),
        (Axis::X, true) => ("X", "longitude", "longitude of the centre of the cell"),
        (Axis::Y, true) => ("Y", "latitude", "latitude of the centre of the cell"),
    };
    let degrees = if axis == Axis::X { "degrees_east" } else { "degrees_north" };
    let units = if is_geographic { degrees.to_owned() } else { length(place) };
    let mut attributes = Attributes::default();
    attributes.add("axis", letter);
    attributes.add("standard_name", standard);
    attributes.add("long_name", long);
    attributes.add("units", units);
    attributes
}

/// The unit of a projected CRS, as UDUNITS names it.
fn length(place: Option<&Georeference>) -> String {
    name_of(metres_per_unit(place.and_then(|place| place.keys.as_ref())).unwrap_or(1.0))
}

/// What the unit of a coordinate counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// Lengths, of so many metres.
    Metres(f64),
    /// Degrees.
    Degrees,
    /// Nothing is said.
    Unsaid,
}

impl Unit {
    /// # Errors
    /// [`Fault::Damaged`] naming a unit that is neither a length nor degrees.
    pub(super) fn of(attributes: &Attributes) -> Result<Self, Fault> {
        let text = attributes.text("units").unwrap_or_default().trim();
        if text.starts_with("degree") {
            return Ok(Self::Degrees);
        }
        if ["", "-", "1"].contains(&text) {
            return Ok(Self::Unsaid);
        }
        let metres = metres_in(text).map(rounded);
        metres.map(Self::Metres).ok_or_else(|| {
            Fault::damaged(format!(
                "coordinates in {text:?}; metres, kilometres, feet (m, km, foot, US_survey_foot) and degrees \
                 are read"
            ))
        })
    }
}

/// What a grid mapping says of the CRS.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Crs {
    pub(super) epsg: Option<u32>,
    pub(super) keys: Option<GeoKeys>,
    is_geographic: Option<bool>,
    /// Metres in the unit of a projected CRS.
    metres: Option<f64>,
    ellipsoid: Option<Ellipsoid>,
    /// Metres in the unit of the heights.
    pub(super) vertical: Option<f64>,
    /// West, width, north, minus height.
    pub(super) transform: Option<[f64; 4]>,
}

impl Crs {
    /// # Errors
    /// [`Fault::Damaged`] for coordinates that are neither lengths on a map nor degrees.
    pub(super) fn of(attributes: &Attributes) -> Result<Self, Fault> {
        let code = |text: &str| text.trim().trim_start_matches("EPSG:").parse().ok();
        let by_code = attributes.text("epsg_code").and_then(code);
        let own = ["crs_wkt", "spatial_ref"].iter().find_map(|name| attributes.text(name));
        let definition = own.or_else(|| wkt_of(by_code?)).and_then(Definition::of);
        let keys = keys(attributes);
        definition.as_ref().map(keys_of_definition).transpose()?;
        keys.as_ref().map(ensure_mapped).transpose()?;
        let by_name = attributes.text("grid_mapping_name").map(|name| name == "latitude_longitude");
        let definition = definition.as_ref();
        let by_kind = |it: &Definition| (it.kind != Kind::Other).then_some(it.kind == Kind::Geographic);
        Ok(Self {
            epsg: by_code.or_else(|| definition?.epsg),
            keys,
            is_geographic: definition.and_then(by_kind).or(by_name),
            metres: definition.and_then(|it| it.metres).map(rounded),
            ellipsoid: ellipsoid(attributes).or_else(|| definition?.ellipsoid),
            vertical: definition.and_then(|it| it.vertical).map(rounded),
            transform: attributes.text(GEO_TRANSFORM).and_then(transform),
        })
    }

    /// The unit of coordinates along which nothing is said of it.
    pub(super) fn unit(&self) -> Unit {
        match (self.is_geographic, self.metres) {
            (Some(true), _) => Unit::Degrees,
            (_, Some(metres)) => Unit::Metres(metres),
            _ => Unit::Unsaid,
        }
    }

    /// Refuses degrees in a CRS of lengths, and lengths in one of degrees.
    pub(super) fn ensure_in(&self, unit: Unit) -> Result<(), Fault> {
        let (is_geographic, told) = match (self.is_geographic, unit) {
            (Some(is_geographic), Unit::Degrees) => (is_geographic, true),
            (Some(is_geographic), Unit::Metres(_)) => (is_geographic, false),
            _ => return Ok(()),
        };
        if is_geographic == told {
            return Ok(());
        }
        let words = |is: bool| if is { "degrees" } else { "a unit of length" };
        Err(Fault::damaged(format!(
            "coordinates are in {}, but its CRS counts in {}; mend `units` of the coordinates or `grid_mapping` of \
             the variable",
            words(told),
            words(is_geographic)
        )))
    }

    /// The keys of a place whose CRS the code alone does not tell, for coordinates in that unit.
    pub(super) fn keys_for(&self, unit: Unit) -> Option<GeoKeys> {
        if self.keys.is_some() {
            return self.keys.clone();
        }
        let bare = Georeference { epsg: self.epsg, origin: [0.0; 2], pixel: [1.0; 2], keys: None };
        let is_geographic = self.is_geographic.unwrap_or(unit == Unit::Degrees);
        let metres = if let Unit::Metres(metres) = unit { metres } else { 1.0 };
        if let (true, None, Some(ellipsoid)) = (is_geographic, self.epsg, self.ellipsoid) {
            return Some(keys_on(ellipsoid));
        }
        let is_told = bare.is_geographic() == is_geographic && (is_geographic || metres == 1.0);
        (!is_told).then(|| keys_by_code(self.epsg, is_geographic, metres))
    }
}

/// The figure of the Earth by the attributes of CF.
fn ellipsoid(attributes: &Attributes) -> Option<Ellipsoid> {
    let sphere = attributes.number("earth_radius").and_then(|radius| Ellipsoid::of(radius, 0.0));
    let major = || {
        let major = attributes.number("semi_major_axis")?;
        let by_minor = || {
            let minor = attributes.number("semi_minor_axis")?;
            Some(if minor == major { 0.0 } else { major / (major - minor) })
        };
        Ellipsoid::of(major, attributes.number("inverse_flattening").or_else(by_minor)?)
    };
    major().or(sphere)
}

fn keys(attributes: &Attributes) -> Option<GeoKeys> {
    let numbers = attributes.numbers(KEYS[0])?;
    Some(GeoKeys {
        directory: numbers.into_iter().map(|number| number as u16).collect(),
        doubles: attributes.numbers(KEYS[1]).unwrap_or_default(),
        ascii: attributes.text(KEYS[2]).unwrap_or_default().to_owned(),
    })
}

/// GDAL's six numbers without those of rotation, which must be 0.
fn transform(text: &str) -> Option<[f64; 4]> {
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|number| number.parse().ok()).collect();
    match numbers?.as_slice() {
        &[west, width, 0.0, north, 0.0, minus_height] => Some([west, width, north, minus_height]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_coordinates_are_lengths_or_degrees() {
        let unit = |text: &str| {
            let mut attributes = Attributes::default();
            attributes.add("units", text);
            Unit::of(&attributes)
        };
        assert_eq!(unit("km"), Ok(Unit::Metres(1000.0)));
        assert_eq!(unit("US_survey_foot"), Ok(Unit::Metres(1200.0 / 3937.0)));
        assert_eq!(unit("201.168 m"), Ok(Unit::Metres(201.168)));
        assert_eq!(unit("degrees_east"), Ok(Unit::Degrees));
        assert_eq!(unit(""), Ok(Unit::Unsaid));
        assert!(unit("rad").is_err_and(|fault| fault.to_string().contains("\"rad\"")));
        assert!(unit("-2 m").is_err());
    }

    #[test]
    fn degrees_and_lengths_do_not_stand_for_each_other() {
        let crs = |is_geographic| Crs { is_geographic: Some(is_geographic), ..Crs::default() };
        assert!(
            crs(true).ensure_in(Unit::Degrees).is_ok() && crs(false).ensure_in(Unit::Metres(1.0)).is_ok()
        );
        assert!(
            crs(true).ensure_in(Unit::Metres(1.0)).is_err() && crs(false).ensure_in(Unit::Degrees).is_err()
        );
    }

    #[test]
    fn keys_are_made_only_where_the_code_does_not_tell() {
        let crs = |epsg, is_geographic| Crs { epsg: Some(epsg), is_geographic, ..Crs::default() };
        assert_eq!(crs(4326, Some(true)).keys_for(Unit::Degrees), None);
        assert_eq!(crs(32616, Some(false)).keys_for(Unit::Metres(1.0)), None);
        // World Equidistant Cylindrical: projected, with a code among the geographic ones.
        let keys = crs(4087, Some(false)).keys_for(Unit::Metres(1.0)).expect("made");
        assert!(!keys.is_geographic());
        let feet = crs(2264, Some(false)).keys_for(Unit::Metres(1200.0 / 3937.0)).expect("made");
        assert_eq!(metres_per_unit(Some(&feet)), Ok(1200.0 / 3937.0));
    }

    #[test]
    #[cfg(not(feature = "wkt"))]
    fn a_build_without_wkt_says_so_of_every_crs() {
        let place = Georeference { epsg: Some(32616), origin: [0.0; 2], pixel: [1.0; 2], keys: None };
        assert!(!is_readable_by_all(&place) && OMITTED_CRS_NOTE.contains("build with the feature `wkt`"));
        let written = attributes(&place);
        assert_eq!(written.text("epsg_code"), Some("EPSG:32616"), "the code is written all the same");
        assert_eq!(written.text("crs_wkt"), None);
    }
}
