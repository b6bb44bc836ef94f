//! The values of an image in tiles of 256 × 256 cells, Deflate with a predictor.
//!
//! Tiles are packed on all cores and put into the file in their order, so the bytes do not depend on threads.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::super::Raster;
use super::super::classes::Whole;
use super::super::raster::number_for_no_data;
use super::directory::tag;
use weald_core::grid::Size;

/// Side of a tile in cells.
pub(super) const TILE: usize = 256;

/// How values are stored.
#[derive(Clone, Copy, Debug)]
pub(super) enum Samples {
    /// 32-bit floats, with the number for no-data.
    Float(f32),
    /// Whole numbers: classes.
    Whole(Whole),
}

impl Samples {
    pub(super) fn of(raster: &Raster) -> Self {
        match &raster.classes {
            Some(classes) => Self::Whole(classes.whole()),
            None => Self::Float(raster.number_for_no_data()),
        }
    }

    /// The same for values of another range than the raster's.
    pub(super) fn within(raster: &Raster, range: (f32, f32)) -> Self {
        match &raster.classes {
            Some(classes) => Self::Whole(classes.whole()),
            None => Self::Float(number_for_no_data(range)),
        }
    }

    pub(super) fn bits(self) -> u16 {
        match self {
            Self::Float(_) => 32,
            Self::Whole(whole) => whole.bits(),
        }
    }

    /// TIFF's number of the type: 1 unsigned, 2 signed, 3 float.
    pub(super) fn format(self) -> u16 {
        match self {
            Self::Float(_) => 3,
            Self::Whole(Whole::Long) => 2,
            Self::Whole(_) => 1,
        }
    }

    pub(super) fn predictor(self) -> u16 {
        match self {
            Self::Float(_) => tag::FLOATING_POINT_PREDICTOR,
            Self::Whole(_) => tag::HORIZONTAL_PREDICTOR,
        }
    }

    pub(super) fn no_data(self) -> f32 {
        match self {
            Self::Float(number) => number,
            Self::Whole(whole) => whole.no_data() as f32,
        }
    }

    fn predicted(self, row: &[f32; TILE]) -> Vec<u8> {
        match self {
            Self::Float(_) => predicted(row).to_vec(),
            Self::Whole(whole) => differences(row, whole),
        }
    }
}

/// All tiles, from the north-western one to the east and south.
pub(super) fn tiles(raster: &Raster, samples: Samples) -> Vec<Vec<u8>> {
    let across = raster.field.size().columns.div_ceil(TILE);
    let down = raster.field.size().rows.div_ceil(TILE);
    let packed = (0..across * down).into_par_iter();
    packed.map(|tile| pack(&tile_rows(raster, tile % across * TILE, tile / across * TILE, samples))).collect()
}

/// The bytes of a tile with its predictor applied; beyond the grid it holds no-data.
fn tile_rows(raster: &Raster, west: usize, north: usize, samples: Samples) -> Vec<u8> {
    let Size { columns, rows } = raster.field.size();
    let no_data = samples.no_data();
    let mut bytes = Vec::with_capacity(TILE * TILE * 4);
    for y in north..north + TILE {
        let mut values = [no_data; TILE];
        if y < rows {
            for (x, value) in (west..columns).zip(&mut values) {
                let index = y * columns + x;
                *value = if raster.is_valid_at(index) { raster.field.values()[index] } else { no_data };
            }
        }
        bytes.extend(samples.predicted(&values));
    }
    bytes
}

/// Adobe's floating-point predictor (Photoshop TIFF technical note 3): the row's most significant bytes, then
/// the next, and so on, and of these the differences from byte to byte.
fn predicted(values: &[f32; TILE]) -> [u8; TILE * 4] {
    let mut row = [0; TILE * 4];
    for (x, value) in values.iter().enumerate() {
        for (plane, byte) in value.to_be_bytes().into_iter().enumerate() {
            row[plane * TILE + x] = byte;
        }
    }
    for at in (1..row.len()).rev() {
        row[at] = row[at].wrapping_sub(row[at - 1]);
    }
    row
}

/// TIFF's predictor 2: differences from number to number.
fn differences(values: &[f32; TILE], whole: Whole) -> Vec<u8> {
    let bytes = usize::from(whole.bits() / 8);
    let mut before = 0_i32;
    let differences = values.iter().flat_map(|value| {
        let number = *value as i32;
        let difference = number.wrapping_sub(std::mem::replace(&mut before, number));
        difference.to_le_bytes().into_iter().take(bytes)
    });
    differences.collect()
}

fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory takes every byte");
    encoder.finish().expect("memory takes every byte")
}
