//! Uniform buffers of equal slots, one of which a dispatch sees.

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::{BindingResource, BufferBinding, BufferSize, BufferUsages};

use crate::gpu::Gpu;
use crate::memory::Store;

/// Uniforms are read in units of four numbers.
const UNIT_BYTES: u64 = 16;

/// A uniform buffer of slots.
#[derive(Debug)]
pub(crate) struct Slots {
    pub(crate) store: Store,
    words: usize,
    bytes: u64,
    stride: u64,
    count: usize,
}

impl Slots {
    /// Room for `count` structs of `words` 32-bit words.
    pub(crate) fn new(gpu: &Gpu, what: &str, words: usize, count: usize) -> Result<Self, Error> {
        let bytes = (4 * words as u64).next_multiple_of(UNIT_BYTES).max(UNIT_BYTES);
        let stride = stride(gpu, bytes);
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let store = Store::new(gpu, what, stride * count as u64, usage)?;
        Ok(Self { store, words, bytes, stride, count })
    }

    /// Structs that it has room for.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The first slot, which an offset moves.
    pub(crate) fn binding(&self) -> BindingResource<'_> {
        let size = BufferSize::new(self.bytes);
        BindingResource::Buffer(BufferBinding { buffer: &self.store.buffer, offset: 0, size })
    }

    /// What moves the binding to a slot.
    pub(crate) fn offset(&self, slot: usize) -> u32 {
        (slot as u64 * self.stride) as u32
    }

    /// Structs as they lie in the buffer, from its first slot on.
    pub(crate) fn packed<'a>(&self, structs: impl Iterator<Item = &'a [u32]>) -> Result<Vec<u8>, Error> {
        let mut packed = Vec::new();
        for words in structs {
            if words.len() != self.words {
                let (given, wanted) = (words.len(), self.words);
                let message = format!("a uniform of {wanted} words was given {given}");
                return Err(DeviceError::new(DeviceErrorKind::Misused, message).into());
            }
            packed.extend_from_slice(bytemuck::cast_slice(words));
            packed.resize(packed.len().next_multiple_of(self.stride as usize), 0);
        }
        Ok(packed)
    }
}

/// Slots of that many bytes that a device can be pointed at, in `room` bytes.
pub(crate) fn fitting(gpu: &Gpu, words: usize, room: u64) -> usize {
    (room / stride(gpu, 4 * words as u64)).max(1) as usize
}

fn stride(gpu: &Gpu, bytes: u64) -> u64 {
    bytes.max(UNIT_BYTES).next_multiple_of(u64::from(gpu.context.limits.min_uniform_buffer_offset_alignment))
}
