//! A picture that comes back from the device.

use weald::Error;
use weald::picture::Image;
use wgpu::{
    Buffer, BufferUsages, COPY_BYTES_PER_ROW_ALIGNMENT, CommandEncoder, Extent3d, MapMode, Origin3d,
    TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect, TextureFormat,
    TextureUsages, TextureView,
};

use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::transfer::unreadable;

/// Bytes of a pixel.
const PIXEL: u32 = 4;

/// A canvas for a finished picture, and the memory through which it comes back.
#[derive(Debug)]
pub(super) struct Readback {
    size: [u32; 2],
    /// Kept as long as it is drawn onto; `None` where another keeps it.
    _canvas: Option<Canvas>,
    texture: Texture,
    /// Of the texture.
    pub(super) view: TextureView,
    memory: Store,
}

impl Readback {
    pub(super) fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let canvas = Canvas::new(gpu, "a picture", Shape::flat(size, TextureFormat::Rgba8Unorm, usage))?;
        let landing = Self::of(gpu, &canvas)?;
        Ok(Self { _canvas: Some(canvas), ..landing })
    }

    /// Of a canvas that another keeps.
    pub(super) fn of(gpu: &Gpu, canvas: &Canvas) -> Result<Self, Error> {
        let (texture, view) = (canvas.texture.clone(), canvas.view.clone());
        let size = [texture.width(), texture.height()];
        let bytes = u64::from(row_bytes(size[0])) * u64::from(size[1]);
        let memory = Store::new(gpu, "a picture", bytes, BufferUsages::COPY_DST | BufferUsages::MAP_READ)?;
        Ok(Self { size, _canvas: None, texture, view, memory })
    }

    /// Encodes the copy into memory.
    pub(super) fn collect(&self, encoder: &mut CommandEncoder) {
        let [width, height] = self.size;
        let from = TexelCopyTextureInfo {
            texture: &self.texture,
            mip_level: 0,
            origin: Origin3d::ZERO,
            aspect: TextureAspect::All,
        };
        let layout =
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes(width)), rows_per_image: None };
        let into = TexelCopyBufferInfo { buffer: &self.memory.buffer, layout };
        encoder.copy_texture_to_buffer(from, into, Extent3d { width, height, depth_or_array_layers: 1 });
    }

    /// The picture, when all that was submitted is done.
    pub(super) fn image(self, gpu: &Gpu) -> Result<Image, Error> {
        let [width, height] = self.size.map(|side| side as usize);
        let rgb = read_back(gpu, &self.memory.buffer, |bytes| {
            let rows = bytes.chunks_exact(row_bytes(self.size[0]) as usize);
            let pixels = rows.flat_map(|row| row[..PIXEL as usize * width].chunks_exact(PIXEL as usize));
            pixels.flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
        })?;
        Ok(Image { width, height, rgb })
    }
}

/// What is read of a buffer, when all that was submitted is done.
pub(super) fn read_back<T>(gpu: &Gpu, buffer: &Buffer, read: impl FnOnce(&[u8]) -> T) -> Result<T, Error> {
    gpu.context.attempt("reading back", || {
        let mapped = gpu.context.answer(|tell| buffer.map_async(MapMode::Read, .., tell))?;
        mapped.ok_or_else(|| unreadable("it gave no answer"))?.map_err(unreadable)?;
        let bytes = buffer.get_mapped_range(..).map_err(unreadable)?;
        let value = read(&bytes);
        drop(bytes);
        buffer.unmap();
        Ok(value)
    })
}

/// Bytes of a row in memory, which copies want to be whole pieces.
fn row_bytes(width: u32) -> u32 {
    (PIXEL * width).next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT)
}
