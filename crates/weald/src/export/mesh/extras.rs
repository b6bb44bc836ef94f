//! What a mesh file says of itself beside its geometry.

use serde_json::{Value, json};

use super::{Finished, Mesh};
use crate::domain::Domain;

/// Where the mesh came from, how true it is and where it lies.
pub(super) fn of(finished: &Finished<'_>, mesh: &Mesh, deviation: f64) -> Value {
    json!({
        "recipe": finished.recipe,
        "recipe_blake3": finished.hash,
        "seed": finished.seed,
        "layer": mesh.of.0,
        "axes": "metres; x east, y up, z south",
        "error": mesh.error,
        "greatest_deviation": deviation,
        "origin": origin(&finished.landscape.domain),
    })
}

/// The middle of the domain in its CRS; nothing where it has no place.
fn origin(domain: &Domain) -> Value {
    let Some(place) = &domain.georeference else { return Value::Null };
    let [x, y] = place.middle(domain.size);
    json!({
        "crs": place.epsg.map(|code| format!("EPSG:{code}")),
        "x": x,
        "y": y,
        "crs_units_a_metre": [place.pixel[0] / domain.cell, place.pixel[1] / domain.cell],
    })
}
