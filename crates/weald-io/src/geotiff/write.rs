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
use weald_core::grid::Size;

/// The bytes of a GeoTIFF file.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    raster.ensure_finite()?;
    assemble(vec![packed(Image::main, raster, Samples::of(raster))])
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
    let images = smaller
        .iter()
        .map(|smaller| packed(|_, size, samples| Image::smaller(size, samples), smaller, samples));
    let file = assemble(std::iter::once(packed(Image::main, raster, samples)).chain(images).collect())?;
    Ok(std::iter::once(Part::own(file)).chain(legend::parts(raster)).collect())
}

/// An image of the file.
pub(super) struct Image {
    /// All tags but those that place the tiles.
    tags: Vec<Entry>,
    /// Bytes of each tile.
    pub(super) lengths: Vec<u64>,
}

impl Image {
    /// The image in full of so many cells, with all that a raster says beside its values.
    pub(super) fn main(raster: &Raster, size: Size, samples: Samples) -> Self {
        let mut tags = image_tags(size, samples);
        tags.push(Entry::text(tag::SOFTWARE, concat!("Weald ", env!("CARGO_PKG_VERSION"))));
        if let Some(provenance) = &raster.provenance {
            tags.push(Entry::text(tag::IMAGE_DESCRIPTION, &provenance.sentence()));
            tags.push(Entry::text(tag::GDAL_METADATA, &metadata::xml(provenance)));
        }
        tags.extend(place_tags(raster, size));
        Self { tags, lengths: Vec::new() }
    }

    /// A smaller image.
    pub(super) fn smaller(size: Size, samples: Samples) -> Self {
        let mut tags = image_tags(size, samples);
        tags.push(Entry::longs(tag::NEW_SUBFILE_TYPE, &[1]));
        Self { tags, lengths: Vec::new() }
    }

    /// All tags in their order, with the tiles from a place of the file on; the places must fit into 32 bits.
    fn placed(&self, mut next: u64) -> Result<Vec<Entry>, Error> {
        let mut offsets = Vec::with_capacity(self.lengths.len());
        for length in &self.lengths {
            offsets.push(fits(next)?);
            next += length;
        }
        let lengths = self.lengths.iter().map(|&length| fits(length)).collect::<Result<Vec<_>, _>>()?;
        let mut tags = self.tags.clone();
        tags.push(Entry::longs(tag::TILE_BYTE_COUNTS, &lengths));
        tags.push(Entry::longs(tag::TILE_OFFSETS, &offsets));
        tags.sort_by_key(|entry| entry.tag);
        Ok(tags)
    }
}

fn fits(place: u64) -> Result<u32, Error> {
    u32::try_from(place).map_err(|_| {
        Error::Run(
            "the file would be longer than the 4 GiB of a TIFF; choose a smaller size, or .zarr".to_owned(),
        )
    })
}

/// Sides of an image of half the size.
pub(super) fn halves(size: Size) -> Size {
    Size { columns: size.columns.div_ceil(2), rows: size.rows.div_ceil(2) }
}

/// An image with its tiles.
fn packed(
    image: impl Fn(&Raster, Size, Samples) -> Image,
    raster: &Raster,
    samples: Samples,
) -> (Image, Vec<Vec<u8>>) {
    let tiles = tiles(raster, samples);
    let lengths = tiles.iter().map(|tile| tile.len() as u64).collect();
    (Image { lengths, ..image(raster, raster.field.size(), samples) }, tiles)
}

/// A tag with its values in little-endian order.
#[derive(Clone)]
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
fn image_tags(size: Size, samples: Samples) -> Vec<Entry> {
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
fn place_tags(raster: &Raster, size: Size) -> Vec<Entry> {
    let (origin, pixel) = match (&raster.georeference, raster.cell) {
        (Some(place), _) => (place.origin, place.pixel),
        (None, Some(cell)) => ([0.0, cell * size.rows as f64], [cell, cell]),
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

/// Header, directories with the values of their tags, tiles, in this order; those of the first image last.
fn assemble(images: Vec<(Image, Vec<Vec<u8>>)>) -> Result<Vec<u8>, Error> {
    let (images, tiles): (Vec<_>, Vec<_>) = images.into_iter().unzip();
    let mut file = directories(&images)?;
    file.extend(tiles.iter().rev().flat_map(|tiles| tiles.concat()));
    Ok(file)
}

/// Header and directories of images whose tiles have these lengths. The largest grid there is fits a classic TIFF with its
/// 4 GiB three times over.
///
/// # Errors
/// [`Error::Run`] where it does not.
pub(super) fn directories(images: &[Image]) -> Result<Vec<u8>, Error> {
    let mut next = (HEADER.len() + images.iter().map(directory_length).sum::<usize>()) as u64;
    let mut placed = Vec::with_capacity(images.len());
    for image in images.iter().rev() {
        placed.push(image.placed(next)?);
        next += image.lengths.iter().sum::<u64>();
    }
    let mut bytes = HEADER.to_vec();
    for (number, tags) in placed.iter().rev().enumerate() {
        let is_last = number + 1 == images.len();
        bytes.extend(directory(tags, bytes.len(), is_last));
    }
    Ok(bytes)
}

/// Bytes of the directory of an image and of the values behind it.
pub(super) fn directory_length(image: &Image) -> usize {
    let places = vec![0; image.lengths.len()];
    let places = [tag::TILE_BYTE_COUNTS, tag::TILE_OFFSETS].map(|tag| Entry::longs(tag, &places));
    length_of(image.tags.iter().chain(&places))
}

/// The header: little-endian, TIFF, the first directory follows.
pub(super) const HEADER: [u8; 8] = *b"II\x2a\0\x08\0\0\0";

/// Bytes of a directory of these tags, and of the values behind it.
fn length_of<'a>(tags: impl Iterator<Item = &'a Entry>) -> usize {
    2 + 4 + tags.map(|tag| 12 + outside_length(tag)).sum::<usize>()
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
    let next = if is_last { 0 } else { (at + length_of(tags.iter())) as u32 };
    bytes.extend(next.to_le_bytes());
    bytes.extend(outside);
    bytes
}
