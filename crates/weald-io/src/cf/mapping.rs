//! The definition of a CRS as WKT, and as the grid mapping attributes of CF 1.11, appendix F.
//!
//! Definitions of EPSG codes are in WKT 1; a build without the feature `wkt` has none. Of the projections, those are
//! spelled out for CF that most national grids use; for the others CF has no name, or not under one parameter
//! each, and the WKT stands alone.

use super::attribute::Attributes;

/// Names of WKT 1 and of CF: the projection's, then those of its parameters.
struct Projection {
    wkt: &'static str,
    cf: &'static str,
    parameters: &'static [(&'static str, &'static str)],
}

const PROJECTIONS: &[Projection] = &[
    Projection {
        wkt: "Transverse_Mercator",
        cf: "transverse_mercator",
        parameters: &[
            ("latitude_of_origin", "latitude_of_projection_origin"),
            ("central_meridian", "longitude_of_central_meridian"),
            ("scale_factor", "scale_factor_at_central_meridian"),
        ],
    },
    Projection {
        wkt: "Lambert_Conformal_Conic_2SP",
        cf: "lambert_conformal_conic",
        parameters: &[
            ("latitude_of_origin", "latitude_of_projection_origin"),
            ("central_meridian", "longitude_of_central_meridian"),
        ],
    },
    Projection {
        wkt: "Albers_Conic_Equal_Area",
        cf: "albers_conical_equal_area",
        parameters: &[
            ("latitude_of_center", "latitude_of_projection_origin"),
            ("longitude_of_center", "longitude_of_central_meridian"),
        ],
    },
    Projection {
        wkt: "Lambert_Azimuthal_Equal_Area",
        cf: "lambert_azimuthal_equal_area",
        parameters: &[
            ("latitude_of_center", "latitude_of_projection_origin"),
            ("longitude_of_center", "longitude_of_projection_origin"),
        ],
    },
];

/// The attributes that say the same as the WKT; none where CF has no words for it.
pub(super) fn cf_attributes(wkt: &str) -> Option<Attributes> {
    let mut attributes = Attributes::default();
    if wkt.starts_with("GEOGCS[") {
        attributes.add("grid_mapping_name", "latitude_longitude");
    } else {
        let name = quoted_after(wkt, "PROJECTION[")?;
        let projection = PROJECTIONS.iter().find(|projection| projection.wkt == name)?;
        attributes.add("grid_mapping_name", projection.cf);
        let shared = [("false_easting", "false_easting"), ("false_northing", "false_northing")];
        for (theirs, ours) in projection.parameters.iter().chain(&shared) {
            attributes.add(ours, parameter(wkt, theirs)?);
        }
        if let Some(first) = parameter(wkt, "standard_parallel_1") {
            let second = parameter(wkt, "standard_parallel_2");
            let parallels = std::iter::once(first).chain(second).collect();
            attributes.0.push(("standard_parallel".to_owned(), super::Attribute::Doubles(parallels)));
        }
    }
    attributes.add("semi_major_axis", number_of(wkt, "SPHEROID[", 0)?);
    attributes.add("inverse_flattening", number_of(wkt, "SPHEROID[", 1)?);
    attributes.add("longitude_of_prime_meridian", number_of(wkt, "PRIMEM[", 0)?);
    Some(attributes)
}

fn quoted_after<'a>(wkt: &'a str, opening: &str) -> Option<&'a str> {
    wkt.split_once(opening)?.1.split('"').nth(1)
}

/// The number at a position behind the name of the first node that opens so.
fn number_of(wkt: &str, opening: &str, position: usize) -> Option<f64> {
    let (_, behind_name) = wkt.split_once(opening)?.1.split_once("\",")?;
    behind_name.split([',', ']']).nth(position)?.parse().ok()
}

fn parameter(wkt: &str, name: &str) -> Option<f64> {
    wkt.split_once(&format!("PARAMETER[\"{name}\","))?.1.split(']').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    #[cfg(feature = "wkt")]
    use super::super::super::wkt::wkt_of;
    #[cfg(feature = "wkt")]
    use super::*;

    #[test]
    #[cfg(feature = "wkt")]
    fn a_national_grid_is_spelled_out_for_cf() {
        let utm = cf_attributes(wkt_of(32616).expect("known")).expect("transverse Mercator");
        assert_eq!(utm.text("grid_mapping_name"), Some("transverse_mercator"));
        assert_eq!(utm.number("longitude_of_central_meridian"), Some(-87.0));
        assert_eq!(utm.number("inverse_flattening"), Some(298.257_223_563));
        let france = cf_attributes(wkt_of(2154).expect("known")).expect("Lambert");
        assert_eq!(france.numbers("standard_parallel"), Some(vec![49.0, 44.0]));
        let degrees = cf_attributes(wkt_of(4326).expect("known")).expect("degrees");
        assert_eq!(degrees.text("grid_mapping_name"), Some("latitude_longitude"));
        assert_eq!(cf_attributes(wkt_of(2056).expect("known")), None, "CF has no oblique Swiss grid");
    }
}
