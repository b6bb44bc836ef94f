//! Writing a raster whose values are not in memory: window by window, to the bytes that the whole gives.

use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::ops::Range;

use super::super::format::WindowedRaster;
use super::super::{Part, Raster};
use super::head::{Image, Variant};
use super::legend;
use super::tiles::{Samples, TILE, tiles};
use super::write::halves;
use weald_core::error::Error;
use weald_core::files::File;
use weald_core::grid::{Field, Mask};
use weald_core::plane::{Plane, Window};

/// Writes one image; gives the files beside it.
pub(super) fn plain(raster: &WindowedRaster<'_, '_>, file: &mut File) -> Result<Vec<Part>, Error> {
    Writing::of(raster, Vec::new()).write(file)
}

/// The same with smaller images, as a cloud-optimized GeoTIFF.
pub(super) fn cloud_optimized(raster: &WindowedRaster<'_, '_>, file: &mut File) -> Result<Vec<Part>, Error> {
    let mut smaller: Vec<Smaller<'_>> = Vec::new();
    let first = ImagePlanes { values: raster.values, valid: raster.valid };
    while let last = smaller.last().map_or(first, Smaller::planes)
        && last.values.size().columns.max(last.values.size().rows) > TILE
    {
        let half = halved(raster, last)?;
        smaller.push(half);
    }
    Writing::of(raster, smaller).write(file)
}

/// The planes of an image.
#[derive(Clone, Copy)]
struct ImagePlanes<'a> {
    values: &'a dyn Plane<f32>,
    valid: Option<&'a dyn Plane<f32>>,
}

/// The planes of a smaller image.
struct Smaller<'b> {
    values: Box<dyn Plane<f32> + 'b>,
    valid: Option<Box<dyn Plane<f32> + 'b>>,
}

impl Smaller<'_> {
    fn planes(&self) -> ImagePlanes<'_> {
        ImagePlanes { values: &*self.values, valid: self.valid.as_ref().map(|valid| &**valid as _) }
    }
}

impl ImagePlanes<'_> {
    /// Some of its rows.
    fn rows(&self, rows: Range<usize>) -> Result<Raster, Error> {
        let window = Window { columns: 0..self.values.size().columns, rows };
        let valid = self.valid.map(|valid| valid.read(&window)).transpose()?;
        let flags = valid.map(|valid| valid.into_iter().map(|flag| flag > 0.0).collect());
        Ok(Raster {
            valid: flags.and_then(|flags| Mask::new(window.size(), flags)),
            ..Raster::from(Field::from_values(window.size(), self.values.read(&window)?))
        })
    }
}

/// A cell for four, as the smaller images of a raster in memory have it.
fn halved<'b>(raster: &WindowedRaster<'_, 'b>, image: ImagePlanes<'_>) -> Result<Smaller<'b>, Error> {
    let size = image.values.size();
    let mut values = (raster.scratch)(halves(size))?;
    let mut valid = image.valid.map(|_| (raster.scratch)(halves(size))).transpose()?;
    for y in 0..size.rows.div_ceil(2) {
        let pair = image.rows(2 * y..(2 * y + 2).min(size.rows))?;
        let row = super::overviews::halved(&Raster { classes: raster.head.classes.clone(), ..pair });
        let window = Window { columns: 0..row.field.size().columns, rows: y..y + 1 };
        values.write(&window, row.field.values())?;
        if let Some(valid) = &mut valid {
            let flag = |x: usize| f32::from(u8::from(row.is_valid_at(x)));
            valid.write(&window, &window.columns.clone().map(flag).collect::<Vec<_>>())?;
        }
    }
    Ok(Smaller { values, valid })
}

/// A file in the making.
struct Writing<'a, 'b> {
    raster: &'a WindowedRaster<'a, 'b>,
    samples: Samples,
    smaller: Vec<Smaller<'b>>,
}

impl<'a, 'b> Writing<'a, 'b> {
    fn of(raster: &'a WindowedRaster<'a, 'b>, smaller: Vec<Smaller<'b>>) -> Self {
        Self { raster, samples: Samples::within(raster.head, raster.range), smaller }
    }

    fn write(&self, file: &mut File) -> Result<Vec<Part>, Error> {
        let first = ImagePlanes { values: self.raster.values, valid: self.raster.valid };
        let planes: Vec<_> = std::iter::once(first).chain(self.smaller.iter().map(Smaller::planes)).collect();
        let mut images: Vec<Image> = Vec::new();
        for plane in &planes {
            let size = plane.values.size();
            let mut image = if images.is_empty() {
                Image::main(self.raster.head, size, self.samples)
            } else {
                Image::smaller(size, self.samples)
            };
            let count = size.columns.div_ceil(TILE) * size.rows.div_ceil(TILE);
            image.lengths = vec![0; count];
            images.push(image);
        }
        let variant = Variant::holding(images.iter().map(|image| image.lengths.len()).sum(), self.samples);
        let mut out = BufWriter::new(file);
        let failed = |cause: std::io::Error| Error::Run(format!("the file cannot be written: {cause}"));
        out.write_all(&vec![0; variant.length(&images)]).map_err(failed)?;
        for (image, plane) in images.iter_mut().zip(&planes).rev() {
            image.lengths.clear();
            for north in (0..plane.values.size().rows).step_by(TILE) {
                for tile in self.tiles(plane, north)? {
                    image.lengths.push(tile.len() as u64);
                    out.write_all(&tile).map_err(failed)?;
                }
            }
        }
        let head = variant.directories(&images)?;
        out.seek(SeekFrom::Start(0))
            .and_then(|_| out.write_all(&head))
            .and_then(|()| out.flush())
            .map_err(failed)?;
        Ok(legend::parts(self.raster.head))
    }

    /// A row of tiles.
    fn tiles(&self, image: &ImagePlanes<'_>, north: usize) -> Result<Vec<Vec<u8>>, Error> {
        let rows = image.rows(north..(north + TILE).min(image.values.size().rows))?;
        rows.ensure_finite()?;
        Ok(tiles(&rows, self.samples))
    }
}
