//! What a mesh file says of itself beside its geometry.

use serde_json::{Value, json};

use crate::Finished;
use weald_core::domain::Domain;

/// Where the mesh came from, how true it is and where it lies.
pub(super) fn of(finished: &Finished<'_>, layer: &str, error: f64, deviation: f64) -> Value {
    let mut extras = source(finished);
    extras["layer"] = layer.into();
    extras["error"] = error.into();
    extras["greatest_deviation"] = deviation.into();
    extras
}

/// Where a file came from and where its origin lies.
pub(crate) fn source(finished: &Finished<'_>) -> Value {
    json!({
        "recipe": finished.recipe,
        "recipe_blake3": finished.hash,
        "seed": finished.seed,
        "axes": "metres; x east, y up, z south",
        "origin": origin(&finished.landscape.domain),
    })
}

/// The middle of the domain in its CRS; nothing where it has no place.
pub(crate) fn origin(domain: &Domain) -> Value {
    let Some(place) = &domain.georeference else { return Value::Null };
    let [x, y] = place.middle(domain.size);
    json!({
        "crs": place.epsg.map(|code| format!("EPSG:{code}")),
        "x": x,
        "y": y,
        "crs_units_a_metre": [place.pixel[0] / domain.cell, place.pixel[1] / domain.cell],
    })
}
