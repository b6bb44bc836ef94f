//! Writing: one band, `float32` or whole numbers where the values are classes; with or without smaller images of it.
//!
//! The smaller images make a cloud-optimized GeoTIFF: all directories stand at the start, the largest image first; the
//! data follow, the largest image last. So a program that shows the whole reads the start of the file alone.

use super::super::Part;
use super::super::Raster;
use super::super::geokeys::keys_for;
use super::directory::tag;
use super::head::{Entry, Image, Variant};
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
    let samples = Samples::of(raster);
    assemble(vec![packed(Image::main, raster, samples)], |tiles| Variant::holding(tiles, samples))
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
    let images = std::iter::once(packed(Image::main, raster, samples)).chain(images).collect();
    let file = assemble(images, |tiles| Variant::holding(tiles, samples))?;
    Ok(std::iter::once(Part::own(file)).chain(legend::parts(raster)).collect())
}

impl Image {
    /// The image in full of so many cells, with all that a raster says beside its values.
    pub(super) fn main(raster: &Raster, size: Size, samples: Samples) -> Self {
        let mut tags = image_tags(size, samples);
        tags.push(Entry::text(tag::SOFTWARE, concat!("Weald ", env!("CARGO_PKG_VERSION"))));
        if let Some(provenance) = &raster.provenance {
            tags.push(Entry::text(tag::IMAGE_DESCRIPTION, &provenance.sentence()));
            tags.push(Entry::text(tag::GDAL_METADATA, &metadata::xml(provenance)));
        } else if let Some(unit) = &raster.unit {
            tags.push(Entry::text(tag::GDAL_METADATA, &metadata::xml_of_unit(unit)));
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
fn assemble(
    images: Vec<(Image, Vec<Vec<u8>>)>,
    variant: impl Fn(usize) -> Variant,
) -> Result<Vec<u8>, Error> {
    let (images, tiles): (Vec<_>, Vec<_>) = images.into_iter().unzip();
    let count = images.iter().map(|image| image.lengths.len()).sum();
    let mut file = variant(count).directories(&images)?;
    file.extend(tiles.iter().rev().flat_map(|tiles| tiles.concat()));
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::super::super::Limits;
    use super::super::decode;
    use super::*;
    use weald_core::grid::Field;

    #[test]
    fn a_file_of_wide_places_holds_what_one_of_narrow_places_does() {
        let size = Size { columns: 600, rows: 300 };
        let values = (0..size.cells()).map(|cell| (cell % 977) as f32 * 0.5).collect();
        let raster = Raster { cell: Some(2.5), ..Raster::from(Field::from_values(size, values)) };
        let samples = Samples::of(&raster);
        let [narrow, wide] = [Variant::Tiff, Variant::BigTiff].map(|variant| {
            let smaller = overviews(&raster).remove(0);
            let images = vec![
                packed(Image::main, &raster, samples),
                packed(|_, size, samples| Image::smaller(size, samples), &smaller, samples),
            ];
            assemble(images, |_| variant).expect("room")
        });
        assert_eq!((&narrow[..4], &wide[..4]), (&b"II\x2a\0"[..], &b"II\x2b\0"[..]));
        let [narrow, wide] = [narrow, wide].map(|file| decode(&file, Limits::default()).expect("whole"));
        assert_eq!(wide.field, raster.field);
        assert_eq!(
            (narrow.field, narrow.cell, narrow.georeference),
            (wide.field, wide.cell, wide.georeference)
        );
    }
}
