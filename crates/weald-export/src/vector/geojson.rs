//! Points, lines and areas with properties as `GeoJSON`.
//!
//! Butler et al., "The `GeoJSON` format", RFC 7946 (2016), doi:10.17487/RFC7946: shores run anticlockwise, islands
//! clockwise, and rings end where they begin. RFC 7946 knows longitude and latitude in WGS 84 alone, and heights above its
//! ellipsoid. Ours are heights above the zero of the model, so that files name their CRS by the member `crs` of the format's
//! first edition (2008), which GDAL and what stands on it read: without it, or with `null`, GDAL takes points with heights for
//! EPSG:4979 and so metres for degrees. Metres from a corner therefore have a CRS of their own there, by its text. A file of RFC 7946 has neither that member nor heights.

use serde_json::{Map, Value, json};

use super::place::Place;
use crate::Finished;
use weald_core::error::Error;

/// Longitude and latitude in WGS 84, which needs no mention.
const WGS_84: u32 = 4326;

/// Metres from the corner of a model without georeferencing, as ISO 19162 spells it.
const METRES: &str = "ENGCRS[\"metres from the south-western corner\",EDATUM[\"south-western corner\"],CS[Cartesian,2],\
                      AXIS[\"x\",east],AXIS[\"y\",north],LENGTHUNIT[\"metre\",1]]";

/// A point: east, north and height in metres.
pub(crate) type Position = [f64; 3];

/// A point, a line or areas with what is known of them.
#[derive(Clone, Debug)]
pub(crate) struct Feature {
    /// Its number.
    pub(crate) id: u64,
    /// Where it is.
    pub(crate) geometry: Geometry,
    /// What is known of it.
    pub(crate) properties: Map<String, Value>,
}

/// The shape of a feature.
#[derive(Clone, Debug)]
pub(crate) enum Geometry {
    /// One point.
    Point(Position),
    /// A line of two or more points.
    Line(Vec<Position>),
    /// Areas, each a shore and islands.
    Areas(Vec<Vec<Vec<Position>>>),
}

/// Which edition of the format is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edition {
    /// That of 2008, with a CRS and heights.
    WithCrs,
    /// RFC 7946: longitude and latitude in WGS 84.
    Rfc7946,
}

impl Edition {
    /// # Errors
    /// [`Error::Run`] for RFC 7946 in another CRS than WGS 84.
    pub(crate) fn of(rfc7946: bool, place: Place<'_>) -> Result<Self, Error> {
        if !rfc7946 {
            return Ok(Self::WithCrs);
        }
        if place.epsg() == Some(WGS_84) {
            return Ok(Self::Rfc7946);
        }
        let crs = place.epsg().map_or_else(|| "no CRS with a code".to_owned(), |code| format!("EPSG:{code}"));
        Err(Error::Run(format!(
            "`rfc7946` is true, but the landscape is in {crs} and RFC 7946 is longitude and latitude in WGS 84: leave \
             it out, and ogr2ogr -t_srs EPSG:4326 -lco RFC7946=YES makes such a file of the one that is written"
        )))
    }
}

/// A file of features, one a line, each of which is made when it is written: there may be millions.
pub(crate) fn write(
    name: &str,
    (place, edition): (Place<'_>, Edition),
    features: impl Iterator<Item = Feature>,
    finished: &Finished<'_>,
) -> Vec<u8> {
    let mut members =
        vec!["\"type\": \"FeatureCollection\"".to_owned(), format!("\"name\": {}", json!(name))];
    if edition == Edition::WithCrs {
        members.push(format!("\"crs\": {}", crs(place)));
    }
    members.push(format!("\"weald\": {}", provenance(finished)));
    let mut text = format!("{{\n{},\n\"features\": [", members.join(",\n"));
    for (at, feature) in features.enumerate() {
        text.push_str(if at == 0 { "\n" } else { ",\n" });
        text.push_str(&feature.json(place.digits(), edition).to_string());
    }
    text.push_str("\n]\n}\n");
    text.into_bytes()
}

fn crs(place: Place<'_>) -> Value {
    let name = match place.epsg() {
        // EPSG:4326 has the latitude first, and GeoJSON the longitude, as OGC's CRS84 has.
        Some(WGS_84) => "urn:ogc:def:crs:OGC:1.3:CRS84".to_owned(),
        Some(code) => format!("urn:ogc:def:crs:EPSG::{code}"),
        None if place.0.georeference.is_none() => METRES.to_owned(),
        None => return Value::Null,
    };
    json!({ "type": "name", "properties": { "name": name } })
}

fn provenance(finished: &Finished<'_>) -> Value {
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "recipe": finished.recipe,
        "recipe_blake3": finished.hash,
        "seed": finished.seed,
    })
}

impl Feature {
    fn json(&self, digits: u32, edition: Edition) -> Value {
        let position = |&[x, y, z]: &Position| match edition {
            Edition::WithCrs => json!([rounded(x, digits), rounded(y, digits), rounded(z, 3)]),
            Edition::Rfc7946 => json!([rounded(x, digits), rounded(y, digits)]),
        };
        let geometry = match &self.geometry {
            Geometry::Point(at) => json!({ "type": "Point", "coordinates": position(at) }),
            Geometry::Line(points) => {
                json!({ "type": "LineString", "coordinates": points.iter().map(position).collect::<Vec<_>>() })
            }
            Geometry::Areas(areas) => {
                let ring = |(at, ring): (usize, &Vec<Position>)| {
                    wound(ring, at == 0).iter().map(position).collect::<Vec<_>>()
                };
                let area =
                    |rings: &Vec<Vec<Position>>| rings.iter().enumerate().map(ring).collect::<Vec<_>>();
                json!({ "type": "MultiPolygon", "coordinates": areas.iter().map(area).collect::<Vec<_>>() })
            }
        };
        json!({ "type": "Feature", "id": self.id, "properties": self.properties, "geometry": geometry })
    }
}

/// A closed ring that runs anticlockwise, or clockwise.
fn wound(ring: &[Position], anticlockwise: bool) -> Vec<Position> {
    let mut ring = ring.to_vec();
    if ring.first() != ring.last() {
        ring.extend(ring.first().copied());
    }
    if (area(&ring) > 0.0) != anticlockwise {
        ring.reverse();
    }
    ring
}

/// The area within a closed ring, negative where it runs clockwise.
fn area(ring: &[Position]) -> f64 {
    // From the first corner, because coordinates of a CRS are large.
    let Some(&[x, y, _]) = ring.first() else { return 0.0 };
    let cross = |pair: &[Position]| (pair[0][0] - x) * (pair[1][1] - y) - (pair[1][0] - x) * (pair[0][1] - y);
    0.5 * ring.windows(2).map(cross).sum::<f64>()
}

/// A number to that many digits behind the point, in as few digits as tell it.
pub(crate) fn rounded(number: f64, digits: u32) -> f64 {
    let scale = 10_f64.powi(digits as i32);
    // Adding 0 makes a plain 0 of -0.
    libm::round(number * scale) / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_but_true_to_the_millimetre() {
        assert_eq!(json!(rounded(730_900.750_499_999, 3)).to_string(), "730900.75");
        assert_eq!(json!(rounded(-84.123_456_789_9, 8)).to_string(), "-84.12345679");
        assert_eq!(json!(rounded(-0.000_01, 3)).to_string(), "0.0");
    }

    #[test]
    fn shores_run_anticlockwise_and_islands_clockwise_however_they_came() {
        let square = vec![[0.0, 0.0, 5.0], [0.0, 2.0, 5.0], [2.0, 2.0, 5.0], [2.0, 0.0, 5.0]];
        let mut turned = square.clone();
        turned.reverse();
        for ring in [&square, &turned] {
            let (shore, island) = (wound(ring, true), wound(ring, false));
            assert_eq!((area(&shore), area(&island)), (4.0, -4.0));
            assert_eq!((shore.len(), shore[0]), (5, shore[4]));
        }
    }
}
