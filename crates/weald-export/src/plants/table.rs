//! Plants as comma-separated values, a row for each (Shafranovich, RFC 4180, 2005).

use std::fmt::Write;

use crate::vector::geojson::rounded;
use crate::vector::place::Place;
use weald_core::plants::{Plant, Plants};

/// The columns. `x` and `y` are those of the CRS, or metres east and north of the south-western corner where there is
/// none; `up_*` is the unit vector along the stem; the turn is clockwise from above.
const HEADER: &str = "id,x,y,z,size,turn_deg,up_east,up_north,up,phase,suitability\n";

/// Characters of a row, more or less.
const ROW: usize = 96;

/// The bytes of the table.
pub(super) fn of(plants: &Plants, place: Place<'_>) -> Vec<u8> {
    let mut text = String::with_capacity(HEADER.len() + ROW * plants.plants.len());
    text.push_str(HEADER);
    for (id, plant) in plants.plants.iter().enumerate() {
        row(&mut text, id, plant, place);
    }
    text.into_bytes()
}

fn row(text: &mut String, id: usize, plant: &Plant, place: Place<'_>) {
    let [east, south, height] = plant.place;
    let [x, y] = place.at([east, south]).map(|along| rounded(along, place.digits()));
    let [up_east, up_south, up] = plant.up.map(|number| rounded(f64::from(number), 4));
    let up_north = 0.0 - up_south;
    let [size, phase, suitability] =
        [plant.size, plant.phase, plant.suitability].map(|number| rounded(f64::from(number), 4));
    let (z, turn) = (rounded(height, 3), rounded(f64::from(plant.turn).to_degrees(), 2));
    let written =
        writeln!(text, "{id},{x},{y},{z},{size},{turn},{up_east},{up_north},{up},{phase},{suitability}");
    written.expect("writing to memory cannot fail");
}
