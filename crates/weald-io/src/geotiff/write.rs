//! Writing: one `float32` band in tiles of 256 × 256 cells, Deflate with the floating-point predictor.
//!
//! Tiles are packed on all cores and put into the file in their order, so the bytes do not depend on threads.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::super::Raster;
use super::super::geokeys::keys_for;
use super::directory::tag;
use super::metadata;
use weald_core::domain::GeoKeys;
use weald_core::error::Error;
use weald_core::grid::Size;

/// Side of a tile in cells.
const TILE: usize = 256;

/// The bytes of a GeoTIFF file.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    raster.ensure_finite()?;
    let no_data = raster.number_for_no_data();
    let across = raster.field.size().columns.div_ceil(TILE);
    let down = raster.field.size().rows.div_ceil(TILE);
    let tiles: Vec<Vec<u8>> = (0..across * down)
        .into_par_iter()
        .map(|tile| pack(&tile_rows(raster, tile % across * TILE, tile / across * TILE, no_data)))
        .collect();
    Ok(assemble(tags(raster, no_data), &tiles))
}

/// The bytes of a tile with its predictor applied; beyond the grid it holds no-data.
fn tile_rows(raster: &Raster, west: usize, north: usize, no_data: f32) -> Vec<u8> {
    let Size { columns, rows } = raster.field.size();
    let mut bytes = Vec::with_capacity(TILE * TILE * 4);
    for y in north..north + TILE {
        let mut values = [no_data; TILE];
        if y < rows {
            for (x, value) in (west..columns).zip(&mut values) {
                let index = y * columns + x;
                *value = if raster.is_valid_at(index) { raster.field.values()[index] } else { no_data };
            }
        }
        bytes.extend(predicted(&values));
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

fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory takes every byte");
    encoder.finish().expect("memory takes every byte")
}

/// A tag with its values in little-endian order.
struct Entry {
    tag: u16,
    kind: u16,
    count: usize,
    values: Vec<u8>,
}

impl Entry {
    fn shorts(tag: u16, numbers: &[u16]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 3, count: numbers.len(), values }
    }

    fn longs(tag: u16, numbers: &[u32]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 4, count: numbers.len(), values }
    }

    fn doubles(tag: u16, numbers: &[f64]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 12, count: numbers.len(), values }
    }

    fn text(tag: u16, text: &str) -> Self {
        let values: Vec<u8> = text.bytes().chain([0]).collect();
        Self { tag, kind: 2, count: values.len(), values }
    }
}

/// All tags but those that place the tiles.
fn tags(raster: &Raster, no_data: f32) -> Vec<Entry> {
    let size = raster.field.size();
    let mut tags = vec![
        Entry::longs(tag::IMAGE_WIDTH, &[size.columns as u32]),
        Entry::longs(tag::IMAGE_LENGTH, &[size.rows as u32]),
        Entry::shorts(tag::BITS_PER_SAMPLE, &[32]),
        Entry::shorts(tag::COMPRESSION, &[tag::DEFLATE]),
        Entry::shorts(tag::PHOTOMETRIC, &[1]),
        Entry::shorts(tag::SAMPLES_PER_PIXEL, &[1]),
        Entry::shorts(tag::PLANAR_CONFIGURATION, &[1]),
        Entry::text(tag::SOFTWARE, concat!("Weald ", env!("CARGO_PKG_VERSION"))),
        Entry::shorts(tag::PREDICTOR, &[tag::FLOATING_POINT_PREDICTOR]),
        Entry::shorts(tag::TILE_WIDTH, &[TILE as u16]),
        Entry::shorts(tag::TILE_LENGTH, &[TILE as u16]),
        Entry::shorts(tag::SAMPLE_FORMAT, &[3]),
        Entry::text(tag::GDAL_NO_DATA, &no_data.to_string().to_lowercase()),
    ];
    if let Some(provenance) = &raster.provenance {
        tags.push(Entry::text(tag::IMAGE_DESCRIPTION, &provenance.sentence()));
        tags.push(Entry::text(tag::GDAL_METADATA, &metadata::xml(provenance)));
    }
    tags.extend(place_tags(raster));
    tags
}

/// Tags of the georeferencing, or of a plain grid in metres with its south-western corner at 0, 0.
fn place_tags(raster: &Raster) -> Vec<Entry> {
    let (origin, pixel) = match (&raster.georeference, raster.cell) {
        (Some(place), _) => (place.origin, place.pixel),
        (None, Some(cell)) => ([0.0, cell * raster.field.size().rows as f64], [cell, cell]),
        (None, None) => return Vec::new(),
    };
    let mut tags = vec![
        Entry::doubles(tag::MODEL_PIXEL_SCALE, &[pixel[0], pixel[1], 0.0]),
        Entry::doubles(tag::MODEL_TIE_POINT, &[0.0, 0.0, 0.0, origin[0], origin[1], 0.0]),
    ];
    tags.extend(raster.georeference.as_ref().and_then(keys_for).iter().flat_map(key_tags));
    tags
}

fn key_tags(keys: &GeoKeys) -> Vec<Entry> {
    let mut tags = vec![Entry::shorts(tag::GEO_KEY_DIRECTORY, &keys.directory)];
    if !keys.doubles.is_empty() {
        tags.push(Entry::doubles(tag::GEO_DOUBLE_PARAMETERS, &keys.doubles));
    }
    if !keys.ascii.is_empty() {
        tags.push(Entry::text(tag::GEO_ASCII_PARAMETERS, &keys.ascii));
    }
    tags
}

/// Header, directory, values of tags, tiles, in this order. The largest grid there is fits a classic TIFF with
/// its 4 GiB four times over.
fn assemble(mut tags: Vec<Entry>, tiles: &[Vec<u8>]) -> Vec<u8> {
    let lengths: Vec<u32> = tiles.iter().map(|tile| tile.len() as u32).collect();
    tags.push(Entry::longs(tag::TILE_BYTE_COUNTS, &lengths));
    tags.push(Entry::longs(tag::TILE_OFFSETS, &vec![0; tiles.len()]));
    tags.sort_by_key(|entry| entry.tag);
    let values_at = 8 + 2 + 12 * tags.len() + 4;
    let tiles_at = values_at + tags.iter().map(outside_length).sum::<usize>();
    let offsets: Vec<u32> = lengths
        .iter()
        .scan(tiles_at as u32, |next, length| Some(std::mem::replace(next, *next + length)))
        .collect();
    for entry in tags.iter_mut().filter(|entry| entry.tag == tag::TILE_OFFSETS) {
        *entry = Entry::longs(tag::TILE_OFFSETS, &offsets);
    }
    let mut file = directory(&tags, values_at);
    file.extend(tiles.concat());
    file
}

/// Bytes that a tag takes behind the directory: none where its values fit in the directory itself.
fn outside_length(entry: &Entry) -> usize {
    if entry.values.len() <= 4 { 0 } else { entry.values.len().next_multiple_of(2) }
}

fn directory(tags: &[Entry], mut values_at: usize) -> Vec<u8> {
    let mut file = b"II\x2a\0\x08\0\0\0".to_vec();
    let mut outside = Vec::new();
    file.extend((tags.len() as u16).to_le_bytes());
    for entry in tags {
        file.extend(entry.tag.to_le_bytes());
        file.extend(entry.kind.to_le_bytes());
        file.extend((entry.count as u32).to_le_bytes());
        let length = outside_length(entry);
        if length == 0 {
            let mut inline = entry.values.clone();
            inline.resize(4, 0);
            file.extend(inline);
        } else {
            file.extend((values_at as u32).to_le_bytes());
            outside.extend(&entry.values);
            outside.resize(outside.len().next_multiple_of(2), 0);
            values_at += length;
        }
    }
    file.extend([0; 4]);
    file.extend(outside);
    file
}
