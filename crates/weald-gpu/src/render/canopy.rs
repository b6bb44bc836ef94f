//! The grass of a landscape as a whole, for where its blades are not drawn: `canopy.wgsl` and `lawn.wgsl`.

use weald::grow::Vegetation;
use weald::grow::grass::Canopy;
use weald::picture::TextureKind;
use weald::{Error, Landscape};
use wgpu::TextureUsages;

use super::maps::{Texels, format, write};
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;

const KIND: TextureKind = TextureKind::Smooth;

/// Ground without grass.
pub(super) fn none(gpu: &Gpu) -> Result<Canvas, Error> {
    upload(gpu, [1, 1], &[0.0; 4])
}

/// The grass of a landscape; `None` where there is none.
pub(super) fn of(gpu: &Gpu, landscape: &Landscape) -> Result<Option<Canvas>, Error> {
    let meadows: Vec<_> = landscape.all_meadows().map(|(_, meadow)| meadow).collect();
    let canopy = Canopy::of(meadows.iter().map(AsRef::as_ref));
    let upload =
        |canopy: Canopy| upload(gpu, [canopy.size.columns, canopy.size.rows], canopy.cells.as_flattened());
    canopy.map(upload).transpose()
}

fn upload(gpu: &Gpu, size: [usize; 2], values: &[f32]) -> Result<Canvas, Error> {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let shape = Shape::flat(size.map(|side| side as u32), format(KIND), usage);
    let canvas = Canvas::new(gpu, "the canopy of grass", shape)?;
    write(gpu, &canvas, &Texels { kind: KIND, columns: size[0], values })?;
    Ok(canvas)
}
