//! Where the blocks of pixels lie in the file, all found and measured before any of them is unpacked.

use super::super::Fault;
use super::super::limits::{MAX_EXPANSION, ensure_can_hold};
use super::header::{Bytes, Header};

/// The blocks of a file: bands of whole rows, or tiles.
#[derive(Debug)]
pub(super) struct Chunks<'a> {
    /// Columns and rows of a block; those at the eastern and southern edges are cut off.
    pub(super) block: [usize; 2],
    /// Blocks in a row of blocks.
    pub(super) across: usize,
    /// Packed bytes of every block, row after row of blocks.
    pub(super) packed: Vec<&'a [u8]>,
}

impl<'a> Chunks<'a> {
    /// Finds all blocks. `table` stands at the table of offsets, `file` is all of the file.
    pub(super) fn find(header: &Header<'_>, file: &'a [u8], table: &mut Bytes<'a>) -> Result<Self, Fault> {
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
    pub(super) fn sides(&self, header: &Header<'_>, index: usize) -> [usize; 2] {
        let [x, y] = self.corner(index);
        [self.block[0].min(header.size.columns - x), self.block[1].min(header.size.rows - y)]
    }

    /// First column and row of a block.
    pub(super) fn corner(&self, index: usize) -> [usize; 2] {
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
