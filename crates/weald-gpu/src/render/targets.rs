//! What pictures are drawn onto: light in 16-bit floats and depth, with samples, and light without.

use weald::Error;
use wgpu::{TextureFormat, TextureUsages};

use super::options::Options;
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;

/// Format of light.
pub(super) const LIGHT: TextureFormat = TextureFormat::Rgba16Float;

/// Format of depth.
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The canvases of a picture.
#[derive(Debug)]
pub(super) struct Targets {
    pub(super) depth: Canvas,
    /// With samples; `None` where a pixel has one.
    pub(super) sampled: Option<Canvas>,
    /// Without.
    pub(super) light: Canvas,
}

impl Targets {
    pub(super) fn new(gpu: &Gpu, options: Options) -> Result<Self, Error> {
        let Options { size, samples } = options;
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let depth = Shape { samples, ..Shape::flat(size, DEPTH, attachment) };
        let sampled = Shape { samples, ..Shape::flat(size, LIGHT, attachment) };
        let light = Shape::flat(size, LIGHT, attachment | TextureUsages::TEXTURE_BINDING);
        Ok(Self {
            depth: Canvas::new(gpu, "depth", depth)?,
            sampled: if samples > 1 { Some(Canvas::new(gpu, "light with samples", sampled)?) } else { None },
            light: Canvas::new(gpu, "light", light)?,
        })
    }
}
