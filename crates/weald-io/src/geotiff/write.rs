//! Writing: one band, `float32` or whole numbers where the values are classes; with or without smaller images of it.
//!
//! The smaller images make a cloud-optimized GeoTIFF: all directories stand at the start, the largest image first; the
//! data follow, the largest image last. So a program that shows the whole reads the start of the file alone.

use super::super::Part;
use super::super::Raster;
use super::super::geokeys::keys_for;
use super::directory::tag;
use super::overviews::overviews;
use super::tiles::{Samples, TILE, tiles};
use super::{legend, metadata};
use weald_core::domain::GeoKeys;
use weald_core::error::Error;

/// The bytes of a GeoTIFF file.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    raster.ensure_finite()?;
    Ok(assemble(vec![Image::of(raster, Samples::of(raster))]))
}

/// The same, and what its classes mean beside it.
pub(super) fn parts(raster: &Raster) -> Result<Vec<Part>, Error> {
    Ok(std::iter::once(Part::own(encode(raster)?)).chain(legend::parts(raster)).collect())
}

/// The same with smaller images, as a cloud-optimized GeoTIFF.
pub(super) fn cloud_optimized(raster: &Raster) -> Result<Vec<Part>, Error> {
    raster.ensure_finite()?;
    let samples = Samples::of(raster);
    let smaller = overviews(raster);
    let images = smaller.iter().map(|smaller| Image::overview(smaller, samples));
    let file = assemble(std::iter::once(Image::of(raster, samples)).chain(images).collect());
    Ok(std::iter::once(Part::own(file)).chain(legend::parts(raster)).collect())
}

/// An image of the file.
struct Image {
    /// All tags but those that place the tiles.
    tags: Vec<Entry>,
    tiles: Vec<Vec<u8>>,
}

impl Image {
    fn of(raster: &Raster, samples: Samples) -> Self {
        let mut tags = image_tags(raster, samples);
        tags.push(Entry::text(tag::SOFTWARE, concat!("Weald ", env!("CARGO_PKG_VERSION"))));
        if let Some(provenance) = &raster.provenance {
            tags.push(Entry::text(tag::IMAGE_DESCRIPTION, &provenance.sentence()));
            tags.push(Entry::text(tag::GDAL_METADATA, &metadata::xml(provenance)));
        }
        tags.extend(place_tags(raster));
        Self { tags, tiles: tiles(raster, samples) }
    }

    fn overview(raster: &Raster, samples: Samples) -> Self {
        let mut tags = image_tags(raster, samples);
        tags.push(Entry::longs(tag::NEW_SUBFILE_TYPE, &[1]));
        Self { tags, tiles: tiles(raster, samples) }
    }
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

/// What every image says of its values.
fn image_tags(raster: &Raster, samples: Samples) -> Vec<Entry> {
    let size = raster.field.size();
    vec![
        Entry::longs(tag::IMAGE_WIDTH, &[size.columns as u32]),
        Entry::longs(tag::IMAGE_LENGTH, &[size.rows as u32]),
        Entry::shorts(tag::BITS_PER_SAMPLE, &[samples.bits()]),
        Entry::shorts(tag::COMPRESSION, &[tag::DEFLATE]),
        Entry::shorts(tag::PHOTOMETRIC, &[1]),
        Entry::shorts(tag::SAMPLES_PER_PIXEL, &[1]),
        Entry::shorts(tag::PLANAR_CONFIGURATION, &[1]),
        Entry::shorts(tag::PREDICTOR, &[samples.predictor()]),
        Entry::shorts(tag::TILE_WIDTH, &[TILE as u16]),
        Entry::shorts(tag::TILE_LENGTH, &[TILE as u16]),
        Entry::shorts(tag::SAMPLE_FORMAT, &[samples.format()]),
        Entry::text(tag::GDAL_NO_DATA, &samples.no_data().to_string().to_lowercase()),
    ]
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

/// Header, directories with the values of their tags, tiles, in this order; those of the first image last. The largest
/// grid there is fits a classic TIFF with its 4 GiB three times over.
fn assemble(mut images: Vec<Image>) -> Vec<u8> {
    for Image { tags, tiles } in &mut images {
        let lengths: Vec<u32> = tiles.iter().map(|tile| tile.len() as u32).collect();
        tags.push(Entry::longs(tag::TILE_BYTE_COUNTS, &lengths));
        tags.push(Entry::longs(tag::TILE_OFFSETS, &vec![0; tiles.len()]));
        tags.sort_by_key(|entry| entry.tag);
    }
    let heads: usize = images.iter().map(|image| directory_length(&image.tags)).sum();
    let mut next = (HEADER.len() + heads) as u32;
    for Image { tags, tiles } in images.iter_mut().rev() {
        let mut offset = |tile: &Vec<u8>| {
            let end = next + tile.len() as u32;
            std::mem::replace(&mut next, end)
        };
        let offsets: Vec<u32> = tiles.iter().map(&mut offset).collect();
        for entry in tags.iter_mut().filter(|entry| entry.tag == tag::TILE_OFFSETS) {
            *entry = Entry::longs(tag::TILE_OFFSETS, &offsets);
        }
    }
    let mut file = HEADER.to_vec();
    for (number, image) in images.iter().enumerate() {
        let is_last = number + 1 == images.len();
        file.extend(directory(&image.tags, file.len(), is_last));
    }
    file.extend(images.iter().rev().flat_map(|image| image.tiles.concat()));
    file
}

/// The header: little-endian, TIFF, the first directory follows.
const HEADER: [u8; 8] = *b"II\x2a\0\x08\0\0\0";

/// Bytes of a directory and of the values behind it.
fn directory_length(tags: &[Entry]) -> usize {
    2 + 12 * tags.len() + 4 + tags.iter().map(outside_length).sum::<usize>()
}

/// Bytes that a tag takes behind the directory: none where its values fit in the directory itself.
fn outside_length(entry: &Entry) -> usize {
    if entry.values.len() <= 4 { 0 } else { entry.values.len().next_multiple_of(2) }
}

/// A directory that stands at a place of the file, where the next one follows it unless it is the last.
fn directory(tags: &[Entry], at: usize, is_last: bool) -> Vec<u8> {
    let mut values_at = at + 2 + 12 * tags.len() + 4;
    let mut bytes = (tags.len() as u16).to_le_bytes().to_vec();
    let mut outside = Vec::new();
    for entry in tags {
        bytes.extend(entry.tag.to_le_bytes());
        bytes.extend(entry.kind.to_le_bytes());
        bytes.extend((entry.count as u32).to_le_bytes());
        let length = outside_length(entry);
        if length == 0 {
            let mut inline = entry.values.clone();
            inline.resize(4, 0);
            bytes.extend(inline);
        } else {
            bytes.extend((values_at as u32).to_le_bytes());
            outside.extend(&entry.values);
            outside.resize(outside.len().next_multiple_of(2), 0);
            values_at += length;
        }
    }
    let next = if is_last { 0 } else { (at + directory_length(tags)) as u32 };
    bytes.extend(next.to_le_bytes());
    bytes.extend(outside);
    bytes
}
