//! Memory of a device: buffers that count against its budget.

use weald::Error;

use crate::gpu::Gpu;
use crate::gpu::budget::{Reservation, in_words};

/// A buffer that counts against the budget.
#[derive(Debug)]
pub(crate) struct Store {
    pub(crate) buffer: wgpu::Buffer,
    _held: Reservation,
}

impl Store {
    /// Allocates; `what` names it in errors.
    pub(crate) fn new(gpu: &Gpu, what: &str, bytes: u64, usage: wgpu::BufferUsages) -> Result<Self, Error> {
        let largest = gpu.context.limits.max_buffer_size;
        if bytes > largest {
            return Err(Error::Device(format!(
                "{what} takes {} in one buffer; {} allows {}; {}",
                in_words(bytes),
                gpu.context.adapter,
                in_words(largest),
                gpu.context.advice.large
            )));
        }
        let held = gpu.memory.hold(bytes, what)?;
        let description =
            wgpu::BufferDescriptor { label: Some(what), size: bytes, usage, mapped_at_creation: false };
        let buffer = gpu.context.attempt(what, || Ok(gpu.context.device.create_buffer(&description)))?;
        Ok(Self { buffer, _held: held })
    }
}
