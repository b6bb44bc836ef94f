//! Numbers of a picture on their way to the device, in the order of what is drawn: of two pictures that are encoded one after
//! the other each has its own.

use wgpu::{BufferDescriptor, BufferUsages, CommandEncoder};

use crate::gpu::Gpu;
use crate::memory::Store;

/// What copies numbers to the device before what is encoded next.
#[derive(Debug)]
pub(super) struct Upload<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) encoder: &'a mut CommandEncoder,
}

impl Upload<'_> {
    /// Encodes the copy of some bytes, a multiple of four, to the beginning of a buffer.
    pub(super) fn write(&mut self, store: &Store, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        let size = bytes.len() as u64;
        let staged = self.gpu.context.device.create_buffer(&BufferDescriptor {
            label: Some("numbers of a picture"),
            size,
            usage: BufferUsages::COPY_SRC,
            mapped_at_creation: true,
        });
        // It is mapped at its creation, unless the device is lost, of which the next call speaks.
        let Ok(mut mapped) = staged.get_mapped_range_mut(..) else { return };
        mapped.copy_from_slice(bytes);
        drop(mapped);
        staged.unmap();
        self.encoder.copy_buffer_to_buffer(&staged, 0, &store.buffer, 0, size);
    }
}
