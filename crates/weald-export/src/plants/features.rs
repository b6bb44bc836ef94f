//! Plants as points for maps, in `GeoJSON`.

use serde_json::{Map, Value, json};

use crate::Finished;
use crate::vector::geojson::{Edition, Feature, Geometry, rounded, write};
use crate::vector::place::Place;
use weald_core::plants::{Plant, Plants};

/// The bytes of the file, whose features have what the columns of the table are called.
pub(super) fn of(
    plants: &Plants,
    (name, edition): (&str, Edition),
    place: Place<'_>,
    finished: &Finished<'_>,
) -> Vec<u8> {
    let features = (0..).zip(&plants.plants).map(|(id, plant)| feature(id, plant, place));
    write(name, (place, edition), features, finished)
}

fn feature(id: u64, plant: &Plant, place: Place<'_>) -> Feature {
    let [east, south, height] = plant.place;
    let [x, y] = place.at([east, south]);
    Feature { id, geometry: Geometry::Point([x, y, height]), properties: properties(id, plant) }
}

fn properties(id: u64, plant: &Plant) -> Map<String, Value> {
    let number = |number: f32| rounded(f64::from(number), 4);
    let [up_east, up_south, up] = plant.up.map(number);
    let properties = json!({
        "id": id,
        "z": rounded(plant.place[2], 3),
        "size": number(plant.size),
        "turn_deg": rounded(f64::from(plant.turn).to_degrees(), 2),
        "up_east": up_east,
        "up_north": 0.0 - up_south,
        "up": up,
        "phase": number(plant.phase),
        "suitability": number(plant.suitability),
    });
    properties.as_object().cloned().unwrap_or_default()
}
