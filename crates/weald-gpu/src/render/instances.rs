//! What is drawn many times at once: triangles by the numbers of their vertices, and instances, of which the buffer grows.

use weald::Error;
use wgpu::{Buffer, BufferUsages, IndexFormat, RenderPass};

use super::upload::Upload;
use crate::gpu::Gpu;
use crate::memory::Store;

/// Instances for which there is room at first.
const ROOM: usize = 1024;

/// Triangles by the numbers of their vertices.
#[derive(Debug)]
pub(super) struct Indices {
    store: Store,
    count: u32,
}

impl Indices {
    pub(super) fn new(gpu: &Gpu, what: &str, indices: &[u16]) -> Result<Self, Error> {
        let bytes: &[u8] = bytemuck::cast_slice(indices);
        let usage = BufferUsages::INDEX | BufferUsages::COPY_DST;
        let store = Store::new(gpu, what, bytes.len() as u64, usage)?;
        gpu.context.queue.write_buffer(&store.buffer, 0, bytes);
        Ok(Self { store, count: indices.len() as u32 })
    }

    pub(super) fn draw<T: bytemuck::Pod>(&self, pass: &mut RenderPass<'_>, instances: &Instances<T>) {
        if instances.count == 0 {
            return;
        }
        pass.set_vertex_buffer(0, instances.buffer().slice(..));
        pass.set_index_buffer(self.store.buffer.slice(..), IndexFormat::Uint16);
        pass.draw_indexed(0..self.count, 0, 0..instances.count);
    }
}

/// Instances, of which the buffer grows.
#[derive(Debug)]
pub(super) struct Instances<T> {
    what: &'static str,
    store: Store,
    pub(super) count: u32,
    kind: std::marker::PhantomData<T>,
}

impl<T: bytemuck::Pod> Instances<T> {
    pub(super) fn new(gpu: &Gpu, what: &'static str) -> Result<Self, Error> {
        Ok(Self { what, store: Self::room(gpu, what, ROOM)?, count: 0, kind: std::marker::PhantomData })
    }

    fn room(gpu: &Gpu, what: &str, count: usize) -> Result<Store, Error> {
        let bytes = (count * size_of::<T>()) as u64;
        Store::new(gpu, what, bytes, BufferUsages::VERTEX | BufferUsages::COPY_DST)
    }

    pub(super) fn buffer(&self) -> &Buffer {
        &self.store.buffer
    }

    pub(super) fn write(&mut self, into: &mut Upload<'_>, instances: &[T]) -> Result<(), Error> {
        let bytes: &[u8] = bytemuck::cast_slice(instances);
        if bytes.len() as u64 > self.store.buffer.size() {
            self.store = Self::room(into.gpu, self.what, instances.len().next_power_of_two())?;
        }
        into.write(&self.store, bytes);
        self.count = instances.len() as u32;
        Ok(())
    }
}
