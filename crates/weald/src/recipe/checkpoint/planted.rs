//! Plants in a checkpoint: their names in its header, their numbers in its body.

use std::io::Write;

use serde::{Deserialize, Serialize};

use super::stream::{HashedReader, HashedWriter};
use weald_core::plants::{Plant, Plants};

/// Three `f64` and seven `f32`.
const BYTES: usize = 3 * 8 + 7 * 4;

/// All but the plants themselves.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct PlantsHeader {
    name: String,
    kind: String,
    spacing: f64,
    count: usize,
}

impl PlantsHeader {
    pub(super) fn of(name: &str, plants: &Plants) -> Self {
        let Plants { kind, spacing, plants } = plants;
        Self { name: name.to_owned(), kind: kind.clone(), spacing: *spacing, count: plants.len() }
    }

    pub(super) fn bytes(&self) -> u128 {
        self.count as u128 * BYTES as u128
    }

    pub(super) fn read(self, file: &mut HashedReader<'_>) -> Result<(String, Plants), String> {
        let plants = file.in_chunks(self.count, read_plant)?;
        Ok((self.name, Plants { kind: self.kind, spacing: self.spacing, plants }))
    }
}

pub(super) fn write<W: Write>(plants: &Plants, out: &mut HashedWriter<W>) -> std::io::Result<()> {
    out.in_chunks(&plants.plants, plant_bytes)
}

fn plant_bytes(plant: &Plant) -> [u8; BYTES] {
    let Plant { place, up: [east, south, up], size, turn, phase, suitability } = *plant;
    let singles = [east, south, up, size, turn, phase, suitability];
    let mut bytes = [0; BYTES];
    let (doubles_at, singles_at) = bytes.split_at_mut(24);
    for (at, number) in doubles_at.as_chunks_mut::<8>().0.iter_mut().zip(place) {
        *at = number.to_le_bytes();
    }
    for (at, number) in singles_at.as_chunks_mut::<4>().0.iter_mut().zip(singles) {
        *at = number.to_le_bytes();
    }
    bytes
}

fn read_plant(bytes: [u8; BYTES]) -> Plant {
    let (doubles, singles) = bytes.split_at(24);
    let double = |at: usize| f64::from_le_bytes(doubles.as_chunks().0[at]);
    let single = |at: usize| f32::from_le_bytes(singles.as_chunks().0[at]);
    Plant {
        place: [double(0), double(1), double(2)],
        up: [single(0), single(1), single(2)],
        size: single(3),
        turn: single(4),
        phase: single(5),
        suitability: single(6),
    }
}
