//! Reading: bands of chunks are decoded on all cores, each into its own rows of the grid.

use rayon::prelude::*;

use super::super::unit::Measure;
use super::super::{Fault, Limits, Raster};
use super::compression::Compression;
use super::directory::Directory;
use super::directory::tag;
use super::layout::{Layout, sample_of};
use super::sample::{Predictor, Sample};
use super::{keys, metadata};

/// Reads the first image of a file.
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let directory = Directory::parse(bytes)?;
    metadata::ensure_no_mask(&directory)?;
    let sample = sample_of(&directory)?;
    let no_data = metadata::no_data(&directory)?.map(|number| sample.nearest(number));
    let compression = Compression::of(directory.number(tag::COMPRESSION)?.unwrap_or(1))?;
    let place = keys::place(&directory)?;
    let coding = Coding {
        layout: Layout::of(&directory, sample, compression, limits)?,
        measure: metadata::measure(&directory, place.vertical)?,
        compression,
        predictor: Predictor::of(directory.number(tag::PREDICTOR)?.unwrap_or(1), sample)?,
        sample,
        no_data,
        directory,
    };
    let (mut values, mut valid) = coding.cells()?;
    if place.is_south_up {
        turn(&mut values, coding.layout.size.columns);
        turn(&mut valid, coding.layout.size.columns);
    }
    let raster =
        Raster::from_file(coding.layout.size, values, valid, sample.name())?.measured(&coding.measure);
    let raster = raster.with_source(metadata::provenance(&coding.directory)?);
    Ok(Raster { cell: place.cell, georeference: place.georeference, ..raster })
}

/// Puts the last row first.
fn turn<T>(cells: &mut [T], columns: usize) {
    let rows = cells.len() / columns;
    for row in 0..rows / 2 {
        let (upper, lower) = cells.split_at_mut((rows - 1 - row) * columns);
        upper[row * columns..][..columns].swap_with_slice(&mut lower[..columns]);
    }
}

/// All that it takes to turn the chunks of a file into values.
struct Coding<'a> {
    directory: Directory<'a>,
    layout: Layout,
    compression: Compression,
    predictor: Predictor,
    sample: Sample,
    no_data: Option<f64>,
    measure: Measure,
}

/// The rows of the grid that one row of chunks covers.
struct Band<'a> {
    index: usize,
    values: &'a mut [f32],
    valid: &'a mut [bool],
}

impl Coding<'_> {
    fn cells(&self) -> Result<(Vec<f32>, Vec<bool>), Fault> {
        let size = self.layout.size;
        let (mut values, mut valid) = (vec![0.0; size.cells()], vec![true; size.cells()]);
        let band_cells = size.columns * self.layout.chunk.rows;
        let results: Vec<Result<(), Fault>> = values
            .par_chunks_mut(band_cells)
            .zip(valid.par_chunks_mut(band_cells))
            .enumerate()
            .map(|(index, (values, valid))| self.read_band(&mut Band { index, values, valid }))
            .collect();
        // The first fault in the order of the file, whichever thread met one first.
        results.into_iter().collect::<Result<(), Fault>>()?;
        Ok((values, valid))
    }

    fn read_band(&self, band: &mut Band<'_>) -> Result<(), Fault> {
        let mut expanded = Vec::new();
        for across in 0..self.layout.across() {
            let index = band.index * self.layout.across() + across;
            let Some(packed) = self.layout.packed(self.directory.bytes, index)? else {
                self.leave_out(band, across);
                continue;
            };
            expanded.resize(self.layout.expanded_bytes(index), 0);
            self.compression
                .expand(packed, &mut expanded)
                .map_err(|cause| Fault::damaged(format!("chunk {index} is damaged: {cause}")))?;
            for (y, row) in expanded.chunks_exact_mut(self.layout.row_bytes()).enumerate() {
                self.read_row(band, self.cells_of_chunk(across, y), row);
            }
        }
        Ok(())
    }

    /// Positions in a band of row `y` of a chunk.
    fn cells_of_chunk(&self, across: usize, y: usize) -> std::ops::Range<usize> {
        let columns = self.layout.size.columns;
        let first = across * self.layout.chunk.columns;
        let last = (first + self.layout.chunk.columns).min(columns);
        y * columns + first..y * columns + last
    }

    fn read_row(&self, band: &mut Band<'_>, cells: std::ops::Range<usize>, row: &mut [u8]) {
        let values = &mut band.values[cells.clone()];
        let valid = &mut band.valid[cells];
        self.predictor.undo(row, self.sample, self.directory.order, |x, value| {
            // The padding of a tile goes on beyond the grid.
            let Some(cell) = values.get_mut(x) else { return };
            let is_no_data = value.is_nan() || self.no_data == Some(value);
            valid[x] = !is_no_data;
            *cell = if is_no_data { 0.0 } else { self.measure.value(value) };
        });
    }

    /// A chunk that a sparse file leaves out is no-data, or 0 where the file declares none.
    fn leave_out(&self, band: &mut Band<'_>, across: usize) {
        for y in 0..band.values.len() / self.layout.size.columns {
            band.valid[self.cells_of_chunk(across, y)].fill(self.no_data.is_none());
            if self.no_data.is_none() {
                band.values[self.cells_of_chunk(across, y)].fill(self.measure.value(0.0));
            }
        }
    }
}
