//! Reading: bands of chunks are decoded on all cores, each into its own rows of the grid.

use std::ops::Range;

use rayon::prelude::*;

use super::super::unit::Measure;
use super::super::{Fault, Limits, Raster};
use super::chunks::{Chunks, Whole};
use super::compression::Compression;
use super::directory::Directory;
use super::directory::tag;
use super::layout::{CheckedSize, Layout, sample_of};
use super::sample::{Predictor, Sample};
use super::{keys, metadata};
use weald_core::file_plane::VALUE;
use weald_core::grid::Size;

/// Reads the first image of a file.
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let chunks = Whole(bytes);
    let coding = Coding::of(Directory::parse(bytes)?, &chunks, &|columns, rows| limits.size(columns, rows))?;
    coding.raster(0..coding.layout.size.rows)
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
pub(super) struct Coding<'a> {
    directory: Directory<'a>,
    chunks: &'a dyn Chunks,
    place: keys::Place,
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

impl<'a> Coding<'a> {
    /// What the directory of a file says of its chunks.
    pub(super) fn of(
        directory: Directory<'a>,
        chunks: &'a dyn Chunks,
        checked: CheckedSize<'_>,
    ) -> Result<Self, Fault> {
        metadata::ensure_no_mask(&directory)?;
        let sample = sample_of(&directory)?;
        let no_data = metadata::no_data(&directory)?.map(|number| sample.nearest(number));
        let compression = Compression::of(directory.number(tag::COMPRESSION)?.unwrap_or(1))?;
        let place = keys::place(&directory)?;
        Ok(Self {
            layout: Layout::of(&directory, sample, compression, (chunks.length(), checked))?,
            measure: metadata::measure(&directory, place.vertical.clone())?,
            compression,
            predictor: Predictor::of(directory.number(tag::PREDICTOR)?.unwrap_or(1), sample)?,
            sample,
            no_data,
            directory,
            chunks,
            place,
        })
    }

    pub(super) fn size(&self) -> Size {
        self.layout.size
    }

    /// Rows of a chunk.
    pub(super) fn rows_at_once(&self) -> usize {
        self.layout.chunk.rows
    }

    /// Bytes of memory for a row of chunks: values, flags, and the chunks of all threads, packed and not.
    pub(super) fn bytes_at_once(&self) -> u64 {
        let cells = self.layout.size.columns as u64 * self.layout.chunk.rows as u64;
        let chunk = self.layout.row_bytes() as u64 * self.layout.chunk.rows as u64;
        cells * (VALUE + 1) + 2 * chunk * rayon::current_num_threads() as u64
    }

    /// Some rows, from north to south.
    pub(super) fn raster(&self, rows: Range<usize>) -> Result<Raster, Fault> {
        let (all, columns) = (self.layout.size.rows, self.layout.size.columns);
        let in_file = if self.place.is_south_up { all - rows.end..all - rows.start } else { rows.clone() };
        let (mut values, mut valid) = self.cells(in_file)?;
        if self.place.is_south_up {
            turn(&mut values, columns);
            turn(&mut valid, columns);
        }
        let size = Size { columns, rows: rows.len() };
        let raster = Raster::from_rows((size, rows.start), values, valid, self.sample.name())?;
        let raster = raster.measured(&self.measure).with_source(metadata::provenance(&self.directory)?);
        Ok(Raster { cell: self.place.cell, georeference: self.place.georeference.clone(), ..raster })
    }

    /// Values and flags of some rows of the file; those of the chunks in which they lie are decoded.
    fn cells(&self, rows: Range<usize>) -> Result<(Vec<f32>, Vec<bool>), Fault> {
        let (columns, high) = (self.layout.size.columns, self.layout.chunk.rows);
        let first_band = rows.start / high;
        let held = first_band * high..rows.end.next_multiple_of(high).min(self.layout.size.rows);
        let (mut values, mut valid) = (vec![0.0; held.len() * columns], vec![true; held.len() * columns]);
        let band_cells = columns * high;
        let results: Vec<Result<(), Fault>> = values
            .par_chunks_mut(band_cells)
            .zip(valid.par_chunks_mut(band_cells))
            .enumerate()
            .map(|(band, (values, valid))| {
                self.read_band(&mut Band { index: first_band + band, values, valid })
            })
            .collect();
        // The first fault in the order of the file, whichever thread met one first.
        results.into_iter().collect::<Result<(), Fault>>()?;
        let wanted = (rows.start - held.start) * columns..(rows.end - held.start) * columns;
        if wanted.len() < values.len() {
            values = values[wanted.clone()].to_vec();
            valid = valid[wanted].to_vec();
        }
        Ok((values, valid))
    }

    fn read_band(&self, band: &mut Band<'_>) -> Result<(), Fault> {
        let mut expanded = Vec::new();
        for across in 0..self.layout.across() {
            let index = band.index * self.layout.across() + across;
            let Some((start, length)) = self.layout.packed(self.chunks.length(), index)? else {
                self.leave_out(band, across);
                continue;
            };
            expanded.resize(self.layout.expanded_bytes(index), 0);
            self.compression
                .expand(&self.chunks.bytes(start, length)?, &mut expanded)
                .map_err(|cause| Fault::damaged(format!("chunk {index} is damaged: {cause}")))?;
            for (y, row) in expanded.chunks_exact_mut(self.layout.row_bytes()).enumerate() {
                self.read_row(band, self.cells_of_chunk(across, y), row);
            }
        }
        Ok(())
    }

    /// Positions in a band of row `y` of a chunk.
    fn cells_of_chunk(&self, across: usize, y: usize) -> Range<usize> {
        let columns = self.layout.size.columns;
        let first = across * self.layout.chunk.columns;
        let last = (first + self.layout.chunk.columns).min(columns);
        y * columns + first..y * columns + last
    }

    fn read_row(&self, band: &mut Band<'_>, cells: Range<usize>, row: &mut [u8]) {
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
