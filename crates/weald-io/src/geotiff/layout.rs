//! How the cells of a file are cut into chunks: strips of whole rows, or tiles.

use super::super::Fault;
use super::super::limits::ensure_can_hold;
use super::chunks::ensure_within;
use super::compression::Compression;
use super::directory::Directory;
use super::directory::tag;
use super::sample::Sample;
use weald_core::grid::Size;

/// Sizes and places of the chunks of a file, checked against its length.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) size: Size,
    /// Columns and rows of a whole chunk.
    pub(super) chunk: Size,
    sample_bits: usize,
    /// How many times the bytes of a chunk its values may take.
    expansion: usize,
    offsets: Vec<u64>,
    lengths: Vec<u64>,
}

/// A size in a header, once it is known to be allowed.
pub(super) type CheckedSize<'a> = &'a dyn Fn(usize, usize) -> Result<Size, Fault>;

/// The tags that place chunks.
struct Tags {
    offsets: u16,
    lengths: u16,
}

/// Tag 262 of an image whose values are places in a table of colours.
const PALETTE: u64 = 3;

const STRIPS: Tags = Tags { offsets: tag::STRIP_OFFSETS, lengths: tag::STRIP_BYTE_COUNTS };
const TILES: Tags = Tags { offsets: tag::TILE_OFFSETS, lengths: tag::TILE_BYTE_COUNTS };

impl Layout {
    /// The layout of a file.
    pub(super) fn of(
        directory: &Directory<'_>,
        sample: Sample,
        compression: Compression,
        (file, checked): (u64, CheckedSize<'_>),
    ) -> Result<Self, Fault> {
        let columns = directory.needed(tag::IMAGE_WIDTH)? as usize;
        let rows = directory.needed(tag::IMAGE_LENGTH)? as usize;
        let size = checked(columns, rows)?;
        let tile_width = directory.number(tag::TILE_WIDTH)?;
        let (chunk, tags) = match tile_width {
            Some(width) => (checked(width as usize, directory.needed(tag::TILE_LENGTH)? as usize)?, TILES),
            None => (strip(directory, size)?, STRIPS),
        };
        let offsets = directory.numbers(tags.offsets)?.unwrap_or_default();
        let lengths = directory.numbers(tags.lengths)?.unwrap_or_default();
        let (sample_bits, expansion) = (sample.bits(), compression.expansion());
        let layout = Self { size, chunk, sample_bits, expansion, offsets, lengths };
        layout.ensure_complete()?;
        layout.ensure_chunks(file)?;
        Ok(layout)
    }

    fn ensure_complete(&self) -> Result<(), Fault> {
        let needed = self.across() * self.size.rows.div_ceil(self.chunk.rows);
        if self.offsets.len() == needed && self.lengths.len() == needed {
            return Ok(());
        }
        Err(Fault::damaged(format!(
            "{} cells in chunks of {} need {needed} chunks, but the file places {} and sizes {}",
            self.size,
            self.chunk,
            self.offsets.len(),
            self.lengths.len()
        )))
    }

    /// Chunks from west to east.
    pub(super) fn across(&self) -> usize {
        self.size.columns.div_ceil(self.chunk.columns)
    }

    /// Bytes of the rows of a chunk that the grid has; the padding below them stays packed.
    pub(super) fn expanded_bytes(&self, index: usize) -> usize {
        let first_row = index / self.across() * self.chunk.rows;
        self.row_bytes() * self.chunk.rows.min(self.size.rows - first_row)
    }

    /// Bytes of a row of a chunk.
    pub(super) fn row_bytes(&self) -> usize {
        (self.chunk.columns * self.sample_bits).div_ceil(8)
    }

    /// Where the bytes of a chunk begin in a file of so many, and how many they are; `None` for one that a sparse file leaves
    /// out, all of it no-data.
    pub(super) fn packed(&self, file: u64, index: usize) -> Result<Option<(u64, usize)>, Fault> {
        let (offset, length) = (self.offsets[index], self.lengths[index]);
        if offset == 0 && length == 0 {
            return Ok(None);
        }
        let named = |fault: Fault| Fault::Damaged(format!("chunk {index}: {fault}"));
        ensure_within(file, offset, length).map_err(named)?;
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        ensure_can_hold(length, self.expanded_bytes(index), self.expansion).map_err(named)?;
        Ok(Some((offset, length)))
    }

    /// Whether every chunk lies in the file and can hold its cells, before memory for the cells is taken.
    fn ensure_chunks(&self, file: u64) -> Result<(), Fault> {
        (0..self.offsets.len()).try_for_each(|index| self.packed(file, index).map(|_| ()))
    }
}

/// Writers give `RowsPerStrip` as 2^32 − 1, or not at all, for one strip of all rows.
fn strip(directory: &Directory<'_>, size: Size) -> Result<Size, Fault> {
    let rows = directory.number(tag::ROWS_PER_STRIP)?.unwrap_or(u64::MAX).min(size.rows as u64);
    if rows == 0 {
        return Err(Fault::damaged("strips of 0 rows; the file is damaged"));
    }
    Ok(Size { rows: rows as usize, ..size })
}

/// The type of the values of a file that holds exactly one band, of numbers and not of colours.
pub(super) fn sample_of(directory: &Directory<'_>) -> Result<Sample, Fault> {
    if directory.number(tag::PHOTOMETRIC)? == Some(PALETTE) {
        return Err(Fault::damaged(
            "the values are places in a table of colours, not heights; heights are read from one band of numbers: if \
             these are numbers, gdal_translate -colorinterp_1 gray in.tif out.tif",
        ));
    }
    if directory.number(tag::FILL_ORDER)?.unwrap_or(1) != 1 {
        return Err(Fault::damaged(
            "the bits of each byte are in reversed order (FillOrder 2): gdal_translate in.tif out.tif",
        ));
    }
    let bands = directory.number(tag::SAMPLES_PER_PIXEL)?.unwrap_or(1);
    if bands != 1 {
        return Err(Fault::damaged(format!(
            "the file has {bands} bands; choose one with `gdal_translate -b 1 in.tif out.tif`"
        )));
    }
    let bits = directory.number(tag::BITS_PER_SAMPLE)?.unwrap_or(1);
    let format = directory.number(tag::SAMPLE_FORMAT)?.unwrap_or(1);
    Sample::of(format, bits)
}
