//! Rasters that tests of files share.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its own part")]

use std::path::{Path, PathBuf};

use tempfile::TempDir;
use weald_core::domain::Georeference;
use weald_core::grid::{Field, Mask, Size};
use weald_core::random::hash2;
use weald_io::{Provenance, Raster};

/// Any finite bit patterns, about one cell in eight without data.
pub fn any_raster(columns: usize, rows: usize, seed: u64) -> Raster {
    let size = Size { columns, rows };
    let bits = |index: usize| hash2(seed, index as i64, 0);
    let is_valid = |index: usize| bits(index) >> 61 != 0;
    let value = |index: usize| Some(f32::from_bits(bits(index) as u32)).filter(|value| value.is_finite());
    let values = |index: usize| if is_valid(index) { value(index).unwrap_or(-9999.0) } else { 0.0 };
    let valid = Mask::new(size, (0..size.cells()).map(is_valid).collect());
    let field = Field::from_values(size, (0..size.cells()).map(values).collect());
    Raster { valid, ..Raster::from(field) }
}

/// Columns and rows of [`hills`].
pub const HILLS: Size = Size { columns: 300, rows: 270 };

/// Hills between 100 and 300 m in Tennessee, with a round lake of no-data.
pub fn hills() -> Raster {
    let height = |x: usize, y: usize| 200.0 + 100.0 * ((x * x + 7 * y) as f32 * 0.001).sin();
    let is_valid =
        |index: usize| (index % 300).abs_diff(150).pow(2) + (index / 300).abs_diff(90).pow(2) > 900;
    let valid = Mask::new(HILLS, (0..HILLS.cells()).map(is_valid).collect());
    let field =
        Field::from_function(HILLS, |x, y| if is_valid(HILLS.index(x, y)) { height(x, y) } else { 0.0 });
    let (low, high) = field.range(valid.as_ref()).expect("land");
    let provenance = Provenance {
        version: "0.1.0".to_owned(),
        recipe_blake3: "af13".repeat(16),
        seed: 7,
        layer: "height".to_owned(),
        unit: "m".to_owned(),
        range: (f64::from(low), f64::from(high)),
        resampled: None,
    };
    Raster { valid, provenance: Some(provenance), ..at(32616, [730_900.75, 4_069_271.25], [80.0; 2], field) }
}

/// A field with georeferencing.
pub fn at(epsg: u32, origin: [f64; 2], pixel: [f64; 2], field: Field) -> Raster {
    let georeference = Some(Georeference { epsg: Some(epsg), origin, pixel, keys: None });
    let cell = (epsg != 4326).then_some(pixel[0]);
    Raster { cell, georeference, ..Raster::from(field) }
}

/// A raster in a file of a folder that is removed with what is given back.
pub fn written(raster: &Raster, name: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    weald_io::write(&path, raster).expect("written");
    (folder, path)
}

/// A fixture of OpenEXR.
pub fn exr_file(name: &str) -> Vec<u8> {
    fixture_of("exr.tar", name)
}

/// A fixture of another format.
pub fn fixture(name: &str) -> Vec<u8> {
    fixture_of("rasters.tar", name)
}

/// A file of an archive of fixtures: in a tar a header of 512 bytes (name, at byte 124 the length in octal digits)
/// goes before each, whose bytes fill whole blocks of as many.
fn fixture_of(archive: &str, name: &str) -> Vec<u8> {
    let archive = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(archive);
    let archive = std::fs::read(archive).expect("the fixtures");
    let mut rest = archive.as_slice();
    while let Some((header, files)) = rest.split_at_checked(512) {
        let text = |range: std::ops::Range<usize>| {
            let bytes = header[range].split(|&byte| byte == 0).next().expect("a first part");
            std::str::from_utf8(bytes).expect("ASCII").trim().to_owned()
        };
        let length = usize::from_str_radix(&text(124..136), 8).unwrap_or(0);
        if text(0..100) == name {
            return files[..length].to_vec();
        }
        rest = files.get(length.next_multiple_of(512)..).unwrap_or_default();
    }
    panic!("no fixture {name}")
}
