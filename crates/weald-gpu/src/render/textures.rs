//! Textures that count against the budget.

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind, Quantity};
use wgpu::{
    Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

use crate::gpu::Gpu;
use crate::gpu::budget::Reservation;

/// What a texture is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    pub(super) size: [u32; 2],
    pub(super) layers: u32,
    pub(super) samples: u32,
    pub(super) format: TextureFormat,
    pub(super) usage: TextureUsages,
    pub(super) is_array: bool,
}

impl Shape {
    /// A picture of one layer and sample.
    pub(super) fn flat(size: [u32; 2], format: TextureFormat, usage: TextureUsages) -> Self {
        Self { size, layers: 1, samples: 1, format, usage, is_array: false }
    }

    fn bytes(self) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(4));
        u64::from(self.size[0]) * u64::from(self.size[1]) * u64::from(self.layers * self.samples) * texel
    }
}

/// A texture with a view of all of it.
#[derive(Debug)]
pub(super) struct Canvas {
    pub(super) texture: wgpu::Texture,
    pub(super) view: TextureView,
    _held: Reservation,
}

impl Canvas {
    /// Columns and rows.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }

    /// Allocates; `what` names it in errors.
    pub(super) fn new(gpu: &Gpu, what: &str, shape: Shape) -> Result<Self, Error> {
        let most = gpu.context.limits.max_texture_dimension_2d;
        if let Some(&side) = shape.size.iter().find(|side| **side > most) {
            let [width, height] = shape.size;
            let message = format!(
                "{what} is a texture of {width} × {height}; {} has at most {most} a side; use a smaller grid, or \
                 --fallback view",
                gpu.context.adapter
            );
            let (what, asked, allowed) = (Quantity::PixelsPerSide, side.into(), 0..=most.into());
            let kind = DeviceErrorKind::OverLimit { what, asked, allowed };
            return Err(DeviceError::new(kind, message).into());
        }
        let held = gpu.memory.hold(shape.bytes(), what)?;
        let [width, height] = shape.size;
        let description = TextureDescriptor {
            label: Some(what),
            size: Extent3d { width, height, depth_or_array_layers: shape.layers },
            mip_level_count: 1,
            sample_count: shape.samples,
            dimension: TextureDimension::D2,
            format: shape.format,
            usage: shape.usage,
            view_formats: &[],
        };
        let dimension = if shape.is_array { TextureViewDimension::D2Array } else { TextureViewDimension::D2 };
        gpu.context.attempt(what, || {
            let texture = gpu.context.device.create_texture(&description);
            let view = texture
                .create_view(&TextureViewDescriptor { dimension: Some(dimension), ..Default::default() });
            Ok(Self { texture, view, _held: held })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_takes_the_bytes_of_all_its_samples() {
        let flat = Shape::flat([16, 8], TextureFormat::Rgba16Float, TextureUsages::COPY_SRC);
        assert_eq!(flat.bytes(), 16 * 8 * 8);
        assert_eq!(Shape { layers: 3, samples: 4, ..flat }.bytes(), 12 * 16 * 8 * 8);
    }
}
