//! Plants as a cloud of points: Turk 1994, "The PLY polygon file format", with a header in ASCII and numbers in binary.

use crate::Finished;
use crate::mesh::extras::origin;
use weald_core::plants::{Plant, Plants};

/// What a point holds. Places are metres east and north of the middle of the domain, and heights; normals go along the
/// stem; `turn` is in radians, clockwise from above.
const PROPERTIES: [&str; 10] = ["x", "y", "z", "nx", "ny", "nz", "size", "turn", "phase", "suitability"];

/// The bytes of the file.
pub(super) fn of(plants: &Plants, finished: &Finished<'_>) -> Vec<u8> {
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Weald {}, recipe {}, seed {}\n",
        env!("CARGO_PKG_VERSION"),
        finished.hash,
        finished.seed
    );
    let mut add = |line: String| header.push_str(&line);
    add("comment metres; x east, y north, z up, from the middle of the landscape\n".to_owned());
    add(format!("comment origin {}\n", origin(&finished.landscape.domain)));
    add(format!("element vertex {}\n", plants.plants.len()));
    for name in PROPERTIES {
        add(format!("property float {name}\n"));
    }
    add("property int id\nend_header\n".to_owned());
    let mut bytes = header.into_bytes();
    bytes.reserve(plants.plants.len() * 4 * (PROPERTIES.len() + 1));
    let middle = finished.landscape.domain.extent().map(|length| 0.5 * length);
    for (id, plant) in plants.plants.iter().enumerate() {
        for number in numbers(plant, middle) {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend((id as i32).to_le_bytes());
    }
    bytes
}

fn numbers(plant: &Plant, middle: [f64; 2]) -> [f32; 10] {
    let [x, y, z] = plant.place;
    let [east, south, up] = plant.up;
    let (x, y) = ((x - middle[0]) as f32, (middle[1] - y) as f32);
    let Plant { size, turn, phase, suitability, .. } = *plant;
    [x, y, z as f32, east, -south, up, size, turn, phase, suitability]
}
