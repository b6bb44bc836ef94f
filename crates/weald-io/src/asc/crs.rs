//! The CRS of a `.prj` file: ESRI's well-known text of UTM zones and of longitude and latitude.
//!
//! Names are those of ESRI's projection engine, by which GDAL and others find the EPSG code again.

use std::fmt::Write;

use super::super::geokeys::{keys_of_definition, rounded};
use super::super::unit::name_of;
use super::super::wkt::{Definition, Kind};
use super::super::{CrsSupport, Fault, Metadata};
use weald_core::domain::{GeoKeys, Georeference};

/// What follows the name of the grid in that of the file with its CRS.
pub(super) const CRS_FILE: &str = ".prj";

/// The CRSs that have no spelling in a `.prj` file.
pub(super) const OMITTED: Metadata = Metadata::Crs(CrsSupport {
    supports: is_spelled,
    loss: "the CRS is left out, so corner and cells are numbers without a unit; .tif holds it",
});

/// A geographic CRS and the EPSG codes of the UTM zones on it.
struct Datum {
    /// Name between `GCS_` or `D_` and the end.
    name: &'static str,
    /// Name before `_UTM_Zone_`.
    short: &'static str,
    /// Name, semi-major axis and inverse flattening.
    spheroid: &'static str,
    epsg: u32,
    /// Codes of zones are this and the number of the zone.
    north: (u32, std::ops::RangeInclusive<u32>),
    south: Option<u32>,
}

const DATUMS: [Datum; 3] = [
    Datum {
        name: "WGS_1984",
        short: "WGS_1984",
        spheroid: "\"WGS_1984\",6378137.0,298.257223563",
        epsg: 4326,
        north: (32600, 1..=60),
        south: Some(32700),
    },
    Datum {
        name: "North_American_1983",
        short: "NAD_1983",
        spheroid: "\"GRS_1980\",6378137.0,298.257222101",
        epsg: 4269,
        north: (26900, 1..=23),
        south: None,
    },
    Datum {
        name: "ETRS_1989",
        short: "ETRS_1989",
        spheroid: "\"GRS_1980\",6378137.0,298.257222101",
        epsg: 4258,
        north: (25800, 28..=38),
        south: None,
    },
];

/// A CRS that can be spelled.
struct Crs {
    epsg: u32,
    datum: &'static Datum,
    /// UTM zone and whether it is a northern one; `None` for longitude and latitude.
    zone: Option<(u32, bool)>,
}

impl Crs {
    fn of(epsg: u32) -> Option<Self> {
        DATUMS.iter().find_map(|datum| {
            let (north, zones) = &datum.north;
            let zone_from = |base: u32| epsg.checked_sub(base).filter(|zone| zones.contains(zone));
            let northern = zone_from(*north).map(|zone| Some((zone, true)));
            let southern = || datum.south.and_then(zone_from).map(|zone| Some((zone, false)));
            let geographic = (epsg == datum.epsg).then_some(None);
            let zone = geographic.or(northern).or_else(southern)?;
            Some(Self { epsg, datum, zone })
        })
    }

    /// ESRI's text with the code at its end, as ArcGIS Pro writes it: without it GDAL knows the projection,
    /// but no code.
    fn wkt(&self) -> String {
        let text = self.text();
        let text = text.strip_suffix(']').expect("every text ends with a bracket");
        format!("{text},AUTHORITY[\"EPSG\",\"{}\"]]", self.epsg)
    }

    fn text(&self) -> String {
        let Datum { name, spheroid, .. } = self.datum;
        let geographic = format!(
            "GEOGCS[\"GCS_{name}\",DATUM[\"D_{name}\",SPHEROID[{spheroid}]],PRIMEM[\"Greenwich\",0.0],\
             UNIT[\"Degree\",0.0174532925199433]]"
        );
        let Some((zone, is_northern)) = self.zone else { return geographic };
        let mut wkt = format!("PROJCS[\"{}\",{geographic},PROJECTION[\"Transverse_Mercator\"]", self.name());
        for (parameter, value) in [
            ("False_Easting", 500_000.0),
            ("False_Northing", if is_northern { 0.0 } else { 10_000_000.0 }),
            ("Central_Meridian", f64::from(zone) * 6.0 - 183.0),
            ("Scale_Factor", 0.9996),
            ("Latitude_Of_Origin", 0.0),
        ] {
            write!(wkt, ",PARAMETER[\"{parameter}\",{value:?}]").expect("memory takes every byte");
        }
        wkt + ",UNIT[\"Meter\",1.0]]"
    }

    /// Whether a definition that has its name or code has coordinates in its unit: metres, or degrees.
    fn counts_as(&self, definition: &Definition) -> bool {
        if self.zone.is_none() {
            return definition.kind == Kind::Geographic && definition.is_in_degrees;
        }
        let is_metre = definition.metres.is_none_or(|metres| rounded(metres) == 1.0);
        definition.kind == Kind::Projected && is_metre
    }

    /// ESRI's name.
    fn name(&self) -> String {
        match self.zone {
            None => format!("GCS_{}", self.datum.name),
            Some((zone, is_northern)) => {
                format!("{}_UTM_Zone_{zone}{}", self.datum.short, if is_northern { 'N' } else { 'S' })
            }
        }
    }
}

/// The EPSG codes that can be spelled.
fn codes() -> impl Iterator<Item = u32> {
    DATUMS.iter().flat_map(|datum| {
        let (north, zones) = datum.north.clone();
        let south = datum.south.into_iter().flat_map({
            let zones = zones.clone();
            move |south| zones.clone().map(move |zone| south + zone)
        });
        [datum.epsg].into_iter().chain(zones.map(move |zone| north + zone)).chain(south)
    })
}

/// Whether the CRS of a place, if it has one, can stand in a `.prj` file.
fn is_spelled(place: &Georeference) -> bool {
    match place.epsg {
        Some(epsg) => Crs::of(epsg).is_some(),
        None => place.keys.is_none(),
    }
}

/// The text of a `.prj` file.
pub(super) fn wkt(place: &Georeference) -> Option<String> {
    place.epsg.and_then(Crs::of).map(|crs| crs.wkt())
}

/// What a `.prj` file says.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Said {
    pub(super) epsg: Option<u32>,
    /// Where the code does not tell all.
    pub(super) keys: Option<GeoKeys>,
    /// Unit of the heights.
    pub(super) unit: Option<String>,
}

/// The CRS behind the text of a `.prj` file.
pub(super) fn read(text: &str) -> Result<Said, Fault> {
    let text = text.trim();
    let kind = text.split('[').next().unwrap_or_default().trim().to_ascii_uppercase();
    let definition = Definition::of(text).filter(|definition| definition.kind != Kind::Other);
    let mut definition = definition.ok_or_else(|| {
        Fault::damaged(format!(
            "the .prj beside it begins with {kind:?}; PROJCS or GEOGCS, a CRS as well-known text, is read: \
             gdalsrsinfo -o wkt_esri EPSG:32633, or remove the file"
        ))
    })?;
    definition.epsg = definition.epsg.or_else(|| by_name(text));
    let unit = definition.vertical.map(|metres| name_of(rounded(metres)));
    if let Some(crs) = definition.epsg.and_then(Crs::of) {
        if crs.counts_as(&definition) {
            return Ok(Said { epsg: definition.epsg, keys: None, unit });
        }
        definition.epsg = None;
    }
    if definition.kind == Kind::Projected && definition.metres.is_none() {
        return Err(Fault::damaged(
            "the .prj beside it gives no metres in a unit: gdalwarp to a CRS in metres, or remove the file",
        ));
    }
    Ok(Said { epsg: definition.epsg, keys: Some(keys_of_definition(&definition)?), unit })
}

/// The code of the CRS that has ESRI's name.
fn by_name(text: &str) -> Option<u32> {
    let name = text.split('"').nth(1)?;
    codes().find(|&code| Crs::of(code).is_some_and(|crs| crs.name() == name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelled_code_is_found_by_its_name_and_by_itself() {
        assert_eq!(codes().count(), 3 + 120 + 23 + 11);
        for code in codes() {
            let crs = Crs::of(code).expect("listed");
            for text in [crs.text(), crs.wkt()] {
                let said = Said { epsg: Some(code), ..Said::default() };
                assert_eq!(read(&text), Ok(said), "{text}");
            }
        }
        assert!(Crs::of(32661).is_none() && Crs::of(25827).is_none(), "a pole and a zone beyond Europe");
    }

    #[test]
    fn the_outermost_authority_is_the_code() {
        let inner = "GEOGCS[\"WGS 84\",AUTHORITY[\"EPSG\",\"4326\"]]";
        let outer = format!("PROJCS[\"a\",{inner},UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"2056\"]]");
        assert_eq!(read(&outer).map(|read| read.epsg), Ok(Some(2056)));
        let without = format!("PROJCS[\"a\",{inner},UNIT[\"metre\",1]]");
        assert_eq!(read(&without).map(|read| read.epsg), Ok(None));
        let new = "PROJCRS[\"a\",LENGTHUNIT[\"metre\",1],\n    ID[\"EPSG\",32616]]";
        assert_eq!(read(new).map(|read| read.epsg), Ok(Some(32616)));
    }

    #[test]
    fn degrees_and_feet_are_told_without_a_code() {
        let degrees = read("GEOGCS[\"GCS_Somewhere\",UNIT[\"Degree\",0.0174532925199433]]").expect("reads");
        let place = |keys| Georeference { epsg: None, origin: [0.0; 2], pixel: [1.0; 2], keys };
        assert!(place(degrees.keys).is_geographic());
        let unit = |number: &str| {
            let said = read(&format!("PROJCS[\"x\",UNIT[\"Foot_US\",{number}]]")).expect("reads");
            super::super::super::geokeys::metres_per_unit(said.keys.as_ref())
        };
        assert_eq!(unit("0.3048006096012192"), Ok(1200.0 / 3937.0));
        assert_eq!(unit("1000.0"), Ok(1000.0), "kilometres");
        assert!(read("hello").is_err_and(|fault| fault.to_string().contains("begins with \"HELLO\"")));
    }

    #[test]
    fn a_zone_that_is_counted_in_feet_is_not_the_one_of_its_name_or_its_code() {
        let zone = Crs::of(32633).expect("listed");
        let feet = "UNIT[\"Foot_US\",0.3048006096012192]";
        for text in [zone.text(), zone.wkt()] {
            let said = read(&text.replace("UNIT[\"Meter\",1.0]", feet)).expect("reads");
            let metres = super::super::super::geokeys::metres_per_unit(said.keys.as_ref());
            assert_eq!((said.epsg, metres), (None, Ok(1200.0 / 3937.0)), "{text}");
        }
        let grads =
            Crs::of(4326).expect("listed").text().replace("0.0174532925199433", "0.01570796326794897");
        assert!(read(&grads).is_err_and(|fault| fault.to_string().contains("not in degrees")));
    }

    #[test]
    fn grads_and_the_centre_of_the_earth_are_refused_and_feet_of_height_are_told() {
        let grads = "GEOGCS[\"GCS_NTF_Paris\",UNIT[\"Grad\",0.01570796326794897]]";
        assert!(read(grads).is_err_and(|fault| fault.to_string().contains("not in degrees")));
        let centre = "GEOCCS[\"WGS 84\",UNIT[\"metre\",1]]";
        assert!(read(centre).is_err_and(|fault| fault.to_string().contains("geocentric")));
        let both = "COMPD_CS[\"both\",PROJCS[\"x\",UNIT[\"metre\",1]],VERT_CS[\"v\",UNIT[\"foot\",0.3048]]]";
        assert_eq!(read(both).expect("reads").unit.as_deref(), Some("international_foot"));
    }
}
