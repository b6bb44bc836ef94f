//! Reading: the blocks of pixels are all found and measured before any of them is unpacked; rows of blocks are decoded on all cores, each into its own rows of the grid.

use rayon::prelude::*;

use super::super::limits::{MAX_EXPANSION, ensure_can_hold};
use super::super::{Fault, Limits, Raster};
use super::attributes;
use super::header::{Bytes, Header, Sample};
use super::piz::Planes;

/// Reads an image of heights.
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let mut front = Bytes { rest: bytes };
    let header = Header::parse(&mut front, limits)?;
    let source = Source::of(&header)?;
    let chunks = Chunks::find(&header, bytes, &mut front)?;
    let values = Coding { header: &header, chunks, source: &source }.values()?;
    let valid = values.iter().map(|value| !value.is_nan()).collect();
    let values = values.into_iter().map(|value| if value.is_nan() { 0.0 } else { value }).collect();
    let raster = Raster::from_file(header.size, values, valid, source.sample.name())?;
    let mut raster = attributes::described(raster, &header.attributes)?;
    raster.notes.extend(source.note);
    Ok(raster)
}

/// The channels of which the heights are read.
struct Source {
    /// Their positions among all channels: that of the heights, and those that must hold the same bits.
    channels: Vec<usize>,
    sample: Sample,
    note: Option<String>,
}

impl Source {
    /// The only channel, or `Y`, or `R`, `G` and `B`.
    fn of(header: &Header<'_>) -> Result<Self, Fault> {
        let channels = &header.channels;
        let find = |name: &str| channels.iter().position(|channel| channel.name == name);
        let (positions, note) = match (channels.as_slice(), find("Y"), ["R", "G", "B"].map(find)) {
            ([_], ..) => (vec![0], None),
            (_, Some(height), _) => {
                (vec![height], Some(format!("of the channels {} only Y was read", names(header))))
            }
            (_, _, [Some(red), Some(green), Some(blue)]) => (vec![red, green, blue], None),
            _ => return Err(several(header)),
        };
        let sample = channels[positions[0]].sample;
        if positions.iter().any(|&position| channels[position].sample != sample) {
            return Err(several(header));
        }
        Ok(Self { channels: positions, sample, note })
    }
}

fn names(header: &Header<'_>) -> String {
    header.channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>().join(", ")
}

fn several(header: &Header<'_>) -> Fault {
    Fault::damaged(format!(
        "the file has the channels {}; heights are read from a single channel, from Y, or from R where G and B \
         are equal to it: write one channel alone",
        names(header)
    ))
}

/// All that it takes to turn the blocks of a file into values.
struct Coding<'a> {
    header: &'a Header<'a>,
    chunks: Chunks<'a>,
    source: &'a Source,
}

impl Coding<'_> {
    fn values(&self) -> Result<Vec<f32>, Fault> {
        let mut values = vec![0.0; self.header.size.cells()];
        let band = self.header.size.columns.saturating_mul(self.chunks.block[1]);
        let bands = values.par_chunks_mut(band).enumerate();
        let results: Vec<Result<(), Fault>> = bands.map(|(down, band)| self.read_band(down, band)).collect();
        // The first fault in the order of the file, whichever thread met one first.
        results.into_iter().collect::<Result<(), Fault>>()?;
        Ok(values)
    }

    fn read_band(&self, down: usize, band: &mut [f32]) -> Result<(), Fault> {
        for index in down * self.chunks.across..(down + 1) * self.chunks.across {
            let [columns, rows] = self.chunks.sides(self.header, index);
            let words = self.header.channels.iter().map(|channel| channel.sample.bytes() / 2).collect();
            let planes = Planes { columns, rows, words };
            let packed = self.chunks.packed[index];
            let bytes = self.header.compression.expand(packed, &planes);
            let bytes =
                bytes.map_err(|cause| Fault::damaged(format!("block {index} is damaged: {cause}")))?;
            let first = self.chunks.corner(index)[0];
            for (y, row) in bytes.chunks_exact(columns * self.header.pixel_bytes()).enumerate() {
                let cells = &mut band[y * self.header.size.columns + first..][..columns];
                self.read_row(row, cells)?;
            }
        }
        Ok(())
    }

    /// The heights in a row of a block, in which channels follow each other.
    fn read_row(&self, row: &[u8], cells: &mut [f32]) -> Result<(), Fault> {
        let samples = |channel: usize| {
            let before = &self.header.channels[..channel];
            let start: usize = before.iter().map(|channel| channel.sample.bytes() * cells.len()).sum();
            &row[start..][..self.source.sample.bytes() * cells.len()]
        };
        let heights = samples(self.source.channels[0]);
        if self.source.channels[1..].iter().any(|&other| samples(other) != heights) {
            return Err(several(self.header));
        }
        for (cell, sample) in cells.iter_mut().zip(heights.chunks_exact(self.source.sample.bytes())) {
            *cell = value(self.source.sample, sample);
        }
        Ok(())
    }
}

fn value(sample: Sample, bytes: &[u8]) -> f32 {
    match (sample, bytes) {
        (Sample::Half, &[a, b]) => half::f16::from_le_bytes([a, b]).to_f32(),
        (Sample::Float, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        (Sample::Uint, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as f32,
        _ => unreachable!("samples have as many bytes as their type says"),
    }
}

/// The blocks of a file: bands of whole rows, or tiles.
#[derive(Debug)]
struct Chunks<'a> {
    /// Columns and rows of a block; those at the eastern and southern edges are cut off.
    block: [usize; 2],
    /// Blocks in a row of blocks.
    across: usize,
    /// Packed bytes of every block, row after row of blocks.
    packed: Vec<&'a [u8]>,
}

impl<'a> Chunks<'a> {
    /// Finds all blocks. `table` stands at the table of offsets, `file` is all of the file.
    fn find(header: &Header<'_>, file: &'a [u8], table: &mut Bytes<'a>) -> Result<Self, Fault> {
        let size = header.size;
        let block = header.tile.unwrap_or([size.columns, header.compression.rows()]);
        let (across, down) = (size.columns.div_ceil(block[0]), size.rows.div_ceil(block[1]));
        ensure_can_hold(file.len(), size.cells().saturating_mul(header.pixel_bytes()), MAX_EXPANSION)?;
        let offsets = table.take((across * down).saturating_mul(8))?;
        let mut chunks = Self { block, across, packed: Vec::with_capacity(across * down) };
        for (index, offset) in offsets.chunks_exact(8).enumerate() {
            let offset = u64::from_le_bytes(offset.try_into().expect("eight bytes"));
            let packed = chunks.packed_at(
                header,
                index,
                usize::try_from(offset).ok().and_then(|at| file.get(at..)),
            )?;
            chunks.packed.push(packed);
        }
        Ok(chunks)
    }

    /// Columns and rows of a block of the file.
    fn sides(&self, header: &Header<'_>, index: usize) -> [usize; 2] {
        let [x, y] = self.corner(index);
        [self.block[0].min(header.size.columns - x), self.block[1].min(header.size.rows - y)]
    }

    /// First column and row of a block.
    fn corner(&self, index: usize) -> [usize; 2] {
        [index % self.across * self.block[0], index / self.across * self.block[1]]
    }

    fn packed_at(
        &self,
        header: &Header<'_>,
        index: usize,
        from: Option<&'a [u8]>,
    ) -> Result<&'a [u8], Fault> {
        let from = from.filter(|rest| !rest.is_empty()).ok_or_else(|| {
            Fault::damaged(format!("block {index} lies outside the file; it is truncated or damaged"))
        })?;
        let mut bytes = Bytes { rest: from };
        self.ensure_is_block(header, index, &mut bytes)?;
        let length = usize::try_from(bytes.number()?)
            .map_err(|_| Fault::damaged(format!("block {index} has a negative length")))?;
        let packed = bytes.take(length)?;
        let [columns, rows] = self.sides(header, index);
        ensure_can_hold(packed.len(), (columns * rows).saturating_mul(header.pixel_bytes()), MAX_EXPANSION)?;
        Ok(packed)
    }

    /// Every block says again which one it is.
    fn ensure_is_block(&self, header: &Header<'_>, index: usize, bytes: &mut Bytes<'_>) -> Result<(), Fault> {
        let is_it = if header.tile.is_some() {
            let at = [bytes.number()?, bytes.number()?, bytes.number()?, bytes.number()?];
            at == [(index % self.across) as i32, (index / self.across) as i32, 0, 0]
        } else {
            i64::from(bytes.number()?) == i64::from(header.corner[1]) + self.corner(index)[1] as i64
        };
        let elsewhere =
            || Fault::damaged(format!("block {index} is not where the table says; the file is damaged"));
        is_it.then_some(()).ok_or_else(elsewhere)
    }
}
