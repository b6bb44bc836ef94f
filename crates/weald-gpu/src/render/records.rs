//! Records of eight words that shaders of vertices read from a texture, two texels each (`records.wgsl`): software that acts as a
//! device (llvmpipe of Mesa 22.3) reads a texel at once, and a buffer vertex by vertex and word by word, which was half of the time
//! in which blades and leaves are made.

use weald::Error;
use wgpu::{
    BindingResource, BindingType, BufferUsages, CommandEncoderDescriptor, Extent3d, Origin3d,
    StorageTextureAccess, TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo, TextureAspect,
    TextureFormat, TextureSampleType, TextureUsages, TextureViewDimension,
};

use super::picture::read_back;
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Words of a record.
pub(super) const WORDS: usize = 8;

/// Records beside each other in a row of the texture, as `records.wgsl` has them.
const ACROSS: u32 = 4096;

/// Bytes of a row, and rows that are sent at once.
const ROW: u32 = 4 * WORDS as u32 * ACROSS;
const ROWS_AT_ONCE: usize = 2;

const FORMAT: TextureFormat = TextureFormat::Rgba32Uint;

/// How a shader reads records.
pub(super) const READ: BindingType = BindingType::Texture {
    sample_type: TextureSampleType::Uint,
    view_dimension: TextureViewDimension::D2,
    multisampled: false,
};

/// How one writes them.
pub(super) const WRITTEN: BindingType = BindingType::StorageTexture {
    access: StorageTextureAccess::WriteOnly,
    format: FORMAT,
    view_dimension: TextureViewDimension::D2,
};

/// Room for some records.
#[derive(Debug)]
pub(super) struct Records {
    canvas: Canvas,
}

impl Records {
    pub(super) fn new(gpu: &Gpu, what: &str, count: u64) -> Result<Self, Error> {
        let rows = count.max(1).div_ceil(u64::from(ACROSS)).try_into().unwrap_or(u32::MAX);
        let usage = TextureUsages::TEXTURE_BINDING
            | TextureUsages::STORAGE_BINDING
            | TextureUsages::COPY_SRC
            | TextureUsages::COPY_DST;
        Ok(Self { canvas: Canvas::new(gpu, what, Shape::flat([2 * ACROSS, rows], FORMAT, usage))? })
    }

    /// How many fit into a texture of a device.
    pub(super) fn most(gpu: &Gpu) -> u64 {
        u64::from(ACROSS) * u64::from(gpu.context.limits.max_texture_dimension_2d)
    }

    pub(super) fn resource(&self) -> BindingResource<'_> {
        BindingResource::TextureView(&self.canvas.view)
    }

    /// Sets the first records, some rows at a time, and waits until they are there.
    pub(super) fn write(&self, gpu: &Gpu, records: &[[u32; WORDS]]) -> Result<(), Error> {
        for (piece, records) in records.chunks(ROWS_AT_ONCE * ACROSS as usize).enumerate() {
            let mut words = records.as_flattened().to_vec();
            words.resize(words.len().next_multiple_of(ROW as usize / 4), 0);
            let _staged = gpu.memory.hold(4 * words.len() as u64, "staging")?;
            let submission = gpu.context.attempt("bringing records to the GPU", || {
                let rows = (words.len() / (ROW as usize / 4)) as u32;
                let place = self.at_row((piece * ROWS_AT_ONCE) as u32);
                gpu.context.queue.write_texture(place, bytemuck::cast_slice(&words), layout(), size(rows));
                Ok(gpu.context.submit([]))
            })?;
            gpu.context.wait(Some(submission))?;
        }
        Ok(())
    }

    /// All words, after all that was submitted: for tests.
    pub(super) fn words(&self, gpu: &Gpu) -> Result<Vec<u32>, Error> {
        let rows = self.canvas.texture.height();
        let bytes = u64::from(ROW) * u64::from(rows);
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        let landing = Store::new(gpu, "records to read back", bytes, usage)?;
        let mut encoder = gpu.context.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let into = TexelCopyBufferInfo { buffer: &landing.buffer, layout: layout() };
        encoder.copy_texture_to_buffer(self.at_row(0), into, size(rows));
        gpu.context.queue.submit([encoder.finish()]);
        read_back(gpu, &landing.buffer, bytemuck::pod_collect_to_vec::<u8, u32>)
    }

    fn at_row(&self, row: u32) -> TexelCopyTextureInfo<'_> {
        let origin = Origin3d { x: 0, y: row, z: 0 };
        TexelCopyTextureInfo {
            texture: &self.canvas.texture,
            mip_level: 0,
            origin,
            aspect: TextureAspect::All,
        }
    }
}

fn layout() -> TexelCopyBufferLayout {
    TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(ROW), rows_per_image: None }
}

fn size(rows: u32) -> Extent3d {
    Extent3d { width: 2 * ACROSS, height: rows, depth_or_array_layers: 1 }
}
