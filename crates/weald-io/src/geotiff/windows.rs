//! Writing a raster whose values are not in memory: window by window, to the bytes that the whole gives.

use std::io::{BufWriter, Seek, SeekFrom, Write};

use super::super::format::WindowedRaster;
use super::super::{Part, Raster};
use super::head::{Image, Variant};
use super::legend;
use super::tiles::{Samples, TILE, tiles};
use super::write::halves;
use weald_core::error::Error;
use weald_core::files::File;
use weald_core::grid::{Field, Size};
use weald_core::plane::{Plane, Window};

/// Writes one image; gives the files beside it.
pub(super) fn plain(raster: &WindowedRaster<'_, '_>, file: &mut File) -> Result<Vec<Part>, Error> {
    Writing::of(raster, Vec::new()).write(file)
}

/// The same with smaller images, as a cloud-optimized GeoTIFF.
pub(super) fn cloud_optimized(raster: &WindowedRaster<'_, '_>, file: &mut File) -> Result<Vec<Part>, Error> {
    let mut smaller: Vec<Box<dyn Plane<f32> + '_>> = Vec::new();
    while let last = smaller.last().map_or(raster.values, |last| &**last)
        && last.size().columns.max(last.size().rows) > TILE
    {
        let half = halved(raster, last)?;
        smaller.push(half);
    }
    Writing::of(raster, smaller).write(file)
}

/// A cell for four, as the smaller images of a raster in memory have it.
fn halved<'b>(
    raster: &WindowedRaster<'_, 'b>,
    plane: &dyn Plane<f32>,
) -> Result<Box<dyn Plane<f32> + 'b>, Error> {
    let Size { columns, rows } = plane.size();
    let mut half = (raster.scratch)(halves(plane.size()))?;
    for y in 0..rows.div_ceil(2) {
        let window = Window { columns: 0..columns, rows: 2 * y..(2 * y + 2).min(rows) };
        let pair = Raster {
            classes: raster.head.classes.clone(),
            ..Raster::from(Field::from_values(window.size(), plane.read(&window)?))
        };
        let row = super::overviews::halved(&pair).field;
        half.write(&Window { columns: 0..row.size().columns, rows: y..y + 1 }, row.values())?;
    }
    Ok(half)
}

/// A file in the making.
struct Writing<'a, 'b> {
    raster: &'a WindowedRaster<'a, 'b>,
    samples: Samples,
    /// The images, the largest first.
    planes: Vec<&'a dyn Plane<f32>>,
    smaller: Vec<Box<dyn Plane<f32> + 'b>>,
}

impl<'a, 'b> Writing<'a, 'b> {
    fn of(raster: &'a WindowedRaster<'a, 'b>, smaller: Vec<Box<dyn Plane<f32> + 'b>>) -> Self {
        Self {
            raster,
            samples: Samples::within(raster.head, raster.range),
            planes: vec![raster.values],
            smaller,
        }
    }

    fn write(&self, file: &mut File) -> Result<Vec<Part>, Error> {
        let planes: Vec<_> =
            self.planes.iter().copied().chain(self.smaller.iter().map(|plane| &**plane)).collect();
        let mut images: Vec<Image> = Vec::new();
        for plane in &planes {
            let size = plane.size();
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
            for north in (0..plane.size().rows).step_by(TILE) {
                for tile in self.tiles(*plane, north)? {
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
    fn tiles(&self, plane: &dyn Plane<f32>, north: usize) -> Result<Vec<Vec<u8>>, Error> {
        let Size { columns, rows } = plane.size();
        let window = Window { columns: 0..columns, rows: north..(north + TILE).min(rows) };
        let rows = Raster::from(Field::from_values(window.size(), plane.read(&window)?));
        rows.ensure_finite()?;
        Ok(tiles(&rows, self.samples))
    }
}
