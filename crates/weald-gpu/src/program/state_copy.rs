//! A copy of a program's state on the device, to go back to.

use weald::Error;
use weald::engine::program::Content;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::BufferUsages;

use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::Pace;
use crate::transfer;

/// Copies of buffers, each of which is made when it is first kept.
#[derive(Debug, Default)]
pub(crate) struct StateCopy {
    copies: Vec<Store>,
    /// Whether the copies are of the state that now runs.
    valid: bool,
}

/// Copies that are kept under numbers.
pub(crate) type NumberedCopies = std::collections::BTreeMap<u64, StateCopy>;

/// A buffer and how many of its bytes count.
pub(crate) type Extent<'a> = (&'a Store, u64);

/// Whether a buffer is part of the state. What passes hand to each other within a step is not, nor is what
/// never changes.
pub(crate) fn is_state(content: &Content) -> bool {
    matches!(content, Content::State(_) | Content::Mean)
}

impl StateCopy {
    /// The copies are of a state that is gone.
    pub(crate) fn forget(&mut self) {
        self.valid = false;
    }

    /// Copies these buffers, the same ones each time.
    pub(crate) fn keep(&mut self, gpu: &Gpu, pace: &mut Pace, state: &[Extent<'_>]) -> Result<(), Error> {
        self.valid = false;
        for (store, _) in &state[self.copies.len().min(state.len())..] {
            let usage = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
            self.copies.push(Store::new(gpu, "a copy of the state", store.buffer.size(), usage)?);
        }
        for ((store, bytes), copy) in state.iter().zip(&self.copies) {
            transfer::copy(gpu, pace, [&store.buffer, &copy.buffer], *bytes)?;
        }
        self.valid = true;
        Ok(())
    }

    /// Copies back.
    pub(crate) fn go_back(&self, gpu: &Gpu, pace: &mut Pace, state: &[Extent<'_>]) -> Result<(), Error> {
        if !self.valid {
            let message = "the GPU was asked to go back to a state that was never kept";
            return Err(DeviceError::new(DeviceErrorKind::Misused, message).into());
        }
        for ((store, bytes), copy) in state.iter().zip(&self.copies) {
            transfer::copy(gpu, pace, [&copy.buffer, &store.buffer], *bytes)?;
        }
        Ok(())
    }
}
