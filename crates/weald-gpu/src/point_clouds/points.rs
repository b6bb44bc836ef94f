//! Points on a device, four numbers each, in as many pieces as what can be bound takes.

use weald::Error;
use weald::grow::ifs::game::CHUNK;
use wgpu::BufferUsages;

use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::Pace;
use crate::transfer::{self, Transfer};

/// Bytes of a point, of its code, and of where it sways to.
pub(crate) const BYTES: u64 = 16;

/// Most points of a piece: 128 MiB, the least that a device must bind. Workgroups of a dispatch stay few, too.
const MAX_POINTS: u64 = 32 * CHUNK;

/// Share of the budget that a buffer of a piece takes at most.
const SHARE: u64 = 8;

/// Points and what was said of them.
#[derive(Debug)]
pub(crate) struct Points {
    pub(crate) gpu: Gpu,
    pub(crate) pace: Pace,
    pub(crate) pieces: Vec<Piece>,
    transfer: Transfer,
}

/// Points in buffers of their own.
#[derive(Debug)]
pub(crate) struct Piece {
    pub(crate) count: u32,
    pub(crate) rests: Store,
    /// Their codes; room for one where there are none.
    pub(crate) codes: Store,
}

impl Points {
    /// Room for points, with their codes where these are wanted. `bytes` is what a point takes in all, so that what
    /// does not fit is refused before anything is made.
    pub(crate) fn new(gpu: &Gpu, count: u64, coded: bool, bytes: u64) -> Result<Self, Error> {
        let transfer = Transfer::new(gpu)?;
        drop(gpu.memory.hold(count.saturating_mul(bytes), &format!("a swaying cloud of {count} points"))?);
        let most = most_of_a_piece(gpu);
        let pieces = (0..count.div_ceil(most)).map(|piece| {
            let count = (count - piece * most).min(most);
            let codes = if coded { count } else { 1 };
            Ok(Piece {
                count: count as u32,
                rests: fours(gpu, "points", count)?,
                codes: fours(gpu, "codes", codes)?,
            })
        });
        let pieces = pieces.collect::<Result<_, Error>>()?;
        Ok(Self { gpu: gpu.clone(), pace: Pace::new(gpu.most_moved), pieces, transfer })
    }

    pub(crate) fn len(&self) -> u64 {
        self.pieces.iter().map(|piece| u64::from(piece.count)).sum()
    }

    /// The fours of all pieces in one of their buffers, after all that was submitted.
    pub(crate) fn read<'a>(
        &'a mut self,
        buffer: impl Fn(usize, &'a Piece) -> &'a Store,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let mut all = Vec::with_capacity(self.len() as usize);
        for (number, piece) in self.pieces.iter().enumerate() {
            let (store, bytes) = (buffer(number, piece), BYTES * u64::from(piece.count));
            let values = self.transfer.read(&self.gpu, &mut self.pace, &store.buffer, bytes)?;
            all.extend_from_slice(bytemuck::cast_slice(&values));
        }
        Ok(all)
    }

    /// Overwrites the fours of all pieces in one of their buffers.
    pub(crate) fn write<T: bytemuck::NoUninit>(
        &self,
        fours: &[T],
        buffer: impl Fn(&Piece) -> &Store,
    ) -> Result<(), Error> {
        let mut rest: &[u8] = bytemuck::cast_slice(fours);
        for piece in &self.pieces {
            let (here, after) = rest.split_at((BYTES * u64::from(piece.count)) as usize);
            transfer::write(&self.gpu, &buffer(piece).buffer, here)?;
            rest = after;
        }
        Ok(())
    }
}

impl Drop for Points {
    /// Memory counts as held until the device no longer works on it.
    fn drop(&mut self) {
        let _ = self.pace.drain(&self.gpu);
    }
}

/// A buffer of vectors of four.
pub(crate) fn fours(gpu: &Gpu, what: &str, count: u64) -> Result<Store, Error> {
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
    Store::new(gpu, what, BYTES * count, usage)
}

/// Whole chunks, so that each piece begins with one.
fn most_of_a_piece(gpu: &Gpu) -> u64 {
    let bytes = gpu.largest_binding().min(gpu.memory.budget() / SHARE);
    (bytes / BYTES / CHUNK * CHUNK).clamp(CHUNK, MAX_POINTS)
}
