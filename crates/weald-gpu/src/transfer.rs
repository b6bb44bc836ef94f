//! Numbers to the device and back, piece by piece through little memory.

use std::collections::VecDeque;
use std::ops::Range;

use weald::Error;
use weald::engine::uniform::Uniform;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::{Buffer, BufferUsages, MapMode};

use crate::gpu::Gpu;
use crate::gpu::context::Submitted;
use crate::memory::Store;
use crate::pace::{Load, Pace, WorkKind};

/// Share of the budget that one piece of staging takes.
const SHARE: u64 = 128;

/// Least and most bytes of a piece.
const PIECE_BYTES: [u64; 2] = [16 << 10, 16 << 20];

/// Bytes of a piece under the budget of a device.
pub(crate) fn piece_bytes(gpu: &Gpu) -> u64 {
    (gpu.memory.budget() / SHARE).clamp(PIECE_BYTES[0], PIECE_BYTES[1]) & !255
}

/// Carries numbers between a program's buffers and the machine.
#[derive(Debug)]
pub(crate) struct Transfer {
    /// Where the device puts a piece for the machine to read.
    landing: Store,
}

impl Transfer {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
        Ok(Self { landing: Store::new(gpu, "a buffer to read back", piece_bytes(gpu), usage)? })
    }

    /// The first bytes of a buffer, after all that was submitted.
    pub(crate) fn read(
        &self,
        gpu: &Gpu,
        pace: &mut Pace,
        from: &Buffer,
        bytes: u64,
    ) -> Result<Vec<f32>, Error> {
        let mut values = Vec::new();
        for (first, length) in pieces(bytes, self.landing.buffer.size()) {
            pace.submit(gpu, copies(length), |encoder| {
                encoder.copy_buffer_to_buffer(from, first, &self.landing.buffer, 0, length);
            })?;
            pace.drain(gpu)?;
            self.take(gpu, length, &mut values)?;
        }
        Ok(values)
    }

    /// Stretches of bytes of a buffer one after the other, after all that was submitted.
    pub(crate) fn read_runs(
        &self,
        gpu: &Gpu,
        pace: &mut Pace,
        from: &Buffer,
        runs: &[Range<u64>],
    ) -> Result<Vec<f32>, Error> {
        let mut values = Vec::new();
        let room = self.landing.buffer.size();
        let mut rest: VecDeque<_> = runs.iter().cloned().collect();
        while !rest.is_empty() {
            let batch = batch(&mut rest, room);
            let length = batch.iter().map(|run| run.end - run.start).sum();
            pace.submit(gpu, copies(length), |encoder| {
                let mut at = 0;
                for run in &batch {
                    encoder.copy_buffer_to_buffer(
                        from,
                        run.start,
                        &self.landing.buffer,
                        at,
                        run.end - run.start,
                    );
                    at += run.end - run.start;
                }
            })?;
            pace.drain(gpu)?;
            self.take(gpu, length, &mut values)?;
        }
        Ok(values)
    }

    /// Appends what has landed.
    fn take(&self, gpu: &Gpu, length: u64, values: &mut Vec<f32>) -> Result<(), Error> {
        let landing = &self.landing.buffer;
        gpu.context.attempt("reading back", || {
            let mapped = gpu.context.answer(|tell| landing.map_async(MapMode::Read, 0..length, tell))?;
            mapped.ok_or_else(|| unreadable("it gave no answer"))?.map_err(unreadable)?;
            let view = landing.get_mapped_range(0..length).map_err(unreadable)?;
            values.extend_from_slice(bytemuck::cast_slice(&view));
            drop(view);
            landing.unmap();
            Ok(())
        })
    }
}

/// Overwrites the start of a buffer, after all that was submitted.
pub(crate) fn write(gpu: &Gpu, into: &Buffer, bytes: &[u8]) -> Result<(), Error> {
    for (first, length) in pieces(bytes.len() as u64, piece_bytes(gpu)) {
        let piece = &bytes[first as usize..][..length as usize];
        let _staged = gpu.memory.hold(length, "staging")?;
        let submission = gpu.context.attempt("writing to the GPU", || {
            gpu.context.queue.write_buffer(into, first, piece);
            Ok(gpu.context.submit([]))
        })?;
        settle(gpu, submission)?;
    }
    Ok(())
}

/// Waits until the memory is free in which the driver staged what was written; a browser looks after that itself.
fn settle(gpu: &Gpu, submission: Submitted) -> Result<(), Error> {
    if gpu.context.waiting.suspends() {
        return gpu.context.check("writing to the GPU");
    }
    gpu.context.wait(Some(submission))
}

/// Takes stretches that fill so many bytes at most; the last may be cut.
fn batch(rest: &mut VecDeque<Range<u64>>, room: u64) -> Vec<Range<u64>> {
    let (mut taken, mut left) = (Vec::new(), room);
    while left > 0
        && let Some(run) = rest.pop_front()
    {
        let end = run.end.min(run.start + left);
        left -= end - run.start;
        taken.push(run.start..end);
        if end < run.end {
            rest.push_front(end..run.end);
        }
    }
    taken
}

/// Overwrites stretches of bytes of a buffer, after all that was submitted.
pub(crate) fn write_runs(gpu: &Gpu, into: &Buffer, runs: &[Range<u64>], bytes: &[u8]) -> Result<(), Error> {
    let mut rest: VecDeque<_> = runs.iter().cloned().collect();
    let mut at = 0;
    while !rest.is_empty() {
        let batch = batch(&mut rest, piece_bytes(gpu));
        let length = batch.iter().map(|run| run.end - run.start).sum();
        let _staged = gpu.memory.hold(length, "staging")?;
        let submission = gpu.context.attempt("writing to the GPU", || {
            for run in batch {
                let length = (run.end - run.start) as usize;
                gpu.context.queue.write_buffer(into, run.start, &bytes[at..][..length]);
                at += length;
            }
            Ok(gpu.context.submit([]))
        })?;
        settle(gpu, submission)?;
    }
    Ok(())
}

/// Copies the first bytes of a buffer over another's.
pub(crate) fn copy(gpu: &Gpu, pace: &mut Pace, [from, into]: [&Buffer; 2], bytes: u64) -> Result<(), Error> {
    let mut first = 0;
    while first < bytes {
        let length = (bytes - first).min(whole_words(pace.allowance(WorkKind::Copies) / 2));
        pace.submit(gpu, copies(2 * length), |encoder| {
            encoder.copy_buffer_to_buffer(from, first, into, first, length);
        })?;
        first += length;
    }
    Ok(())
}

/// Sets the first bytes of a buffer to zero.
pub(crate) fn clear(gpu: &Gpu, pace: &mut Pace, buffer: &Buffer, bytes: u64) -> Result<(), Error> {
    let mut first = 0;
    while first < bytes {
        let length = (bytes - first).min(whole_words(pace.allowance(WorkKind::Copies)));
        pace.submit(gpu, copies(length), |encoder| encoder.clear_buffer(buffer, first, Some(length)))?;
        first += length;
    }
    Ok(())
}

fn copies(bytes: u64) -> Load {
    Load { sort: WorkKind::Copies, bytes, staged: None }
}

/// A length that copies may have.
fn whole_words(bytes: u64) -> u64 {
    (bytes & !255).max(256)
}

/// First byte and length of each piece.
fn pieces(bytes: u64, most: u64) -> impl Iterator<Item = (u64, u64)> {
    (0..bytes).step_by(most as usize).map(move |first| (first, most.min(bytes - first)))
}

/// A struct as shaders see it.
pub(crate) fn uniform(gpu: &Gpu, what: &str, value: &impl Uniform) -> Result<Store, Error> {
    // A struct takes whole vectors of four.
    let mut words = value.words();
    words.resize(words.len().next_multiple_of(4), 0);
    let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    let store = Store::new(gpu, what, 4 * words.len() as u64, usage)?;
    gpu.context.queue.write_buffer(&store.buffer, 0, bytemuck::cast_slice(&words));
    Ok(store)
}

/// A buffer could not be read.
pub(crate) fn unreadable(cause: impl std::fmt::Display) -> Error {
    DeviceError::new(DeviceErrorKind::Failed, format!("reading back failed: {cause}")).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cover_everything_once() {
        assert_eq!(pieces(10, 4).collect::<Vec<_>>(), [(0, 4), (4, 4), (8, 2)]);
        assert_eq!(pieces(8, 4).collect::<Vec<_>>(), [(0, 4), (4, 4)]);
        assert_eq!(pieces(0, 4).count(), 0);
    }
}
