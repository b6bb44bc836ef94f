//! Numbers that come back from the device some pictures after they were asked for, without waiting.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use weald::Error;
use wgpu::{BufferAsyncError, BufferUsages, CommandEncoder, MapMode};

use crate::gpu::Gpu;
use crate::memory::Store;
use crate::transfer::unreadable;

/// Memory through which they come.
#[derive(Debug)]
pub(super) struct Returning {
    store: Store,
    bytes: u64,
    state: State,
}

#[derive(Debug)]
enum State {
    Free,
    Encoded,
    Mapping(Receiver<Result<(), BufferAsyncError>>),
}

impl Returning {
    /// Room for so many bytes; `what` names them in errors.
    pub(super) fn new(gpu: &Gpu, what: &str, room: u64) -> Result<Self, Error> {
        let store = Store::new(gpu, what, room, BufferUsages::COPY_DST | BufferUsages::MAP_READ)?;
        Ok(Self { store, bytes: 0, state: State::Free })
    }

    /// Whether nothing is coming.
    pub(super) fn is_free(&self) -> bool {
        matches!(self.state, State::Free)
    }

    /// Encodes the copy of the first bytes of a buffer.
    pub(super) fn copy(&mut self, encoder: &mut CommandEncoder, from: &Store, bytes: u64) {
        encoder.copy_buffer_to_buffer(&from.buffer, 0, &self.store.buffer, 0, bytes);
        (self.bytes, self.state) = (bytes, State::Encoded);
    }

    /// What was encoded was submitted: it may come.
    pub(super) fn submitted(&mut self) {
        if matches!(self.state, State::Encoded) {
            let (sender, mapped) = channel();
            let tell = move |done| {
                let _ = sender.send(done);
            };
            self.store.buffer.map_async(MapMode::Read, ..self.bytes, tell);
            self.state = State::Mapping(mapped);
        }
    }

    /// What has come; `None` while nothing has.
    pub(super) fn take<T: bytemuck::AnyBitPattern + bytemuck::NoUninit>(
        &mut self,
    ) -> Result<Option<Vec<T>>, Error> {
        let State::Mapping(mapped) = &self.state else { return Ok(None) };
        match mapped.try_recv() {
            Err(TryRecvError::Empty) => return Ok(None),
            done => done.map_err(unreadable)?.map_err(unreadable)?,
        }
        let mapped = self.store.buffer.get_mapped_range(..self.bytes).map_err(unreadable)?;
        let values = bytemuck::pod_collect_to_vec(&mapped);
        drop(mapped);
        self.store.buffer.unmap();
        self.state = State::Free;
        Ok(Some(values))
    }
}
