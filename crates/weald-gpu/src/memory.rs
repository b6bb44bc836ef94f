//! Memory of a device: buffers that count against its budget.

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind, Quantity, bytes_in_words};

use crate::gpu::Gpu;
use crate::gpu::budget::Reservation;

/// A buffer that counts against the budget.
#[derive(Debug)]
pub(crate) struct Store {
    pub(crate) buffer: wgpu::Buffer,
    _held: Reservation,
    _destroyed: Option<Destroyed>,
}

/// A buffer whose memory is free at once when this is dropped: a browser frees it only when it next looks for what
/// nobody uses.
#[derive(Debug)]
struct Destroyed(wgpu::Buffer);

impl Drop for Destroyed {
    fn drop(&mut self) {
        self.0.destroy();
    }
}

impl Store {
    /// Allocates; `what` names it in errors.
    pub(crate) fn new(gpu: &Gpu, what: &str, bytes: u64, usage: wgpu::BufferUsages) -> Result<Self, Error> {
        let largest = gpu.context.limits.max_buffer_size;
        if bytes > largest {
            let message = format!(
                "{what} takes {} in one buffer; {} allows {}; {}",
                bytes_in_words(bytes),
                gpu.context.adapter,
                bytes_in_words(largest),
                gpu.context.advice.large
            );
            return Err(DeviceError::new(too_many_bytes(bytes, largest), message).into());
        }
        let held = gpu.memory.hold(bytes, what)?;
        let description =
            wgpu::BufferDescriptor { label: Some(what), size: bytes, usage, mapped_at_creation: false };
        let buffer = gpu.context.attempt(what, || Ok(gpu.context.device.create_buffer(&description)))?;
        // Who draws may have recorded a use of it that is yet to be submitted; who waits for all that it does has not.
        let destroyed = gpu.context.waiting.suspends().then(|| Destroyed(buffer.clone()));
        Ok(Self { buffer, _held: held, _destroyed: destroyed })
    }
}

/// One buffer is larger than the device allows.
pub(crate) fn too_many_bytes(asked: u64, largest: u64) -> DeviceErrorKind {
    DeviceErrorKind::OverLimit { what: Quantity::MemoryBytes, asked, allowed: 0..=largest }
}
