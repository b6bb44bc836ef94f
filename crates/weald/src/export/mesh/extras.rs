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
    let [columns, rows] = [domain.size.columns, domain.size.rows].map(|count| count as f64);
    json!({
        "crs": place.epsg.map(|code| format!("EPSG:{code}")),
        "x": place.origin[0] + 0.5 * columns * place.pixel[0],
        "y": place.origin[1] - 0.5 * rows * place.pixel[1],
        "crs_units_a_metre": [place.pixel[0] / domain.cell, place.pixel[1] / domain.cell],
    })
}
