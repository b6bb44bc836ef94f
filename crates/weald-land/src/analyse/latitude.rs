//! The latitude of a landscape, from its coordinate reference system.
//!
//! For zones of the universal transverse Mercator projection: Snyder 1987, "Map projections, a working manual",
//! doi 10.3133/pp1395, eq. 3-26, 7-19, 8-12 and the first terms of 8-17, on the ellipsoid of WGS 84. Within the zone
//! that is right to a hundredth of a degree.

use weald_core::domain::{Domain, Georeference};

/// Semi-major axis in metres and first eccentricity squared of WGS 84; that of GRS 80 is the same here.
const AXIS: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARED: f64 = 0.006_694_380;

/// Scale on the central meridian.
const SCALE: f64 = 0.9996;

/// Easting of the central meridian, and northing of the equator in southern zones.
const FALSE_EASTING: f64 = 500_000.0;
const FALSE_NORTHING: f64 = 10_000_000.0;

/// Latitude of the middle of a landscape in degrees, north positive; `None` where its CRS does not tell.
pub(super) fn latitude_deg(domain: &Domain) -> Option<f64> {
    let place = domain.georeference.as_ref()?;
    let [east, north] = place.middle(domain.size);
    let latitude = if place.is_geographic() {
        north
    } else {
        let from_equator = north - false_northing(place)?;
        of_transverse_mercator(east - FALSE_EASTING, from_equator)
    };
    (-90.0..=90.0).contains(&latitude).then_some(latitude)
}

/// Northing of the equator, for EPSG codes of UTM zones.
fn false_northing(place: &Georeference) -> Option<f64> {
    /// `ProjectedCSTypeGeoKey`.
    const PROJECTED: u16 = 3072;
    let key = || place.keys.as_ref().and_then(|keys| keys.short(PROJECTED)).map(u32::from);
    match place.epsg.or_else(key)? {
        // WGS 84 and WGS 72, ETRS 89, NAD 83 and NAD 27, in the north.
        32601..=32660 | 32201..=32260 | 25828..=25838 | 26901..=26923 | 26701..=26722 => Some(0.0),
        32701..=32760 | 32301..=32360 => Some(FALSE_NORTHING),
        _ => None,
    }
}

fn of_transverse_mercator(east: f64, north: f64) -> f64 {
    let e2 = ECCENTRICITY_SQUARED;
    let root = libm::sqrt(1.0 - e2);
    let e1 = (1.0 - root) / (1.0 + root);
    let arc = north / SCALE;
    let mu = arc / (AXIS * (1.0 - e2 / 4.0 - 3.0 * e2 * e2 / 64.0));
    let foot = mu
        + (3.0 * e1 / 2.0 - 27.0 * e1 * e1 * e1 / 32.0) * libm::sin(2.0 * mu)
        + (21.0 * e1 * e1 / 16.0) * libm::sin(4.0 * mu)
        + (151.0 * e1 * e1 * e1 / 96.0) * libm::sin(6.0 * mu);
    let sine = libm::sin(foot);
    let bend = 1.0 - e2 * sine * sine;
    let across = AXIS / libm::sqrt(bend);
    let along = AXIS * (1.0 - e2) / (bend * libm::sqrt(bend));
    let offset = east / (across * SCALE);
    (foot - across * libm::tan(foot) / along * offset * offset / 2.0).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    fn at(epsg: u32, middle: [f64; 2], pixel: f64) -> Option<f64> {
        let size = Size::square(2).expect("small");
        let origin = [middle[0] - pixel, middle[1] + pixel];
        let georeference = Georeference { epsg: Some(epsg), origin, pixel: [pixel; 2], keys: None };
        latitude_deg(&Domain { georeference: Some(georeference), ..Domain::new(size, 10.0) })
    }

    /// Eastings and northings as GDAL gives them: `echo 12 47 | gdaltransform -s_srs EPSG:4326 -t_srs EPSG:32632`.
    #[test]
    fn utm_and_degrees_give_the_latitude_of_the_middle() {
        let close = |found: Option<f64>, expected: f64| {
            let found = found.expect("a known CRS");
            assert!((found - expected).abs() < 0.01, "{found} instead of {expected}");
        };
        close(at(32632, [500_000.0, 5_205_164.0], 30.0), 47.0);
        close(at(32632, [728_070.0, 5_209_533.0], 30.0), 47.0);
        close(at(32733, [638_528.0, 6_236_830.0], 30.0), -34.0);
        close(at(4326, [9.0, 47.25], 0.001), 47.25);
    }

    #[test]
    fn an_unknown_place_has_no_latitude() {
        assert_eq!(latitude_deg(&Domain::new(Size::square(2).expect("small"), 10.0)), None);
        assert_eq!(at(3857, [1.0e6, 6.0e6], 30.0), None);
    }
}
