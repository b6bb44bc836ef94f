//! Images inside a mesh file.

use super::normal_map::normal_map;
use super::sampling::Sampling;
use super::slopes::Slopes;
use super::tin::Tin;
use super::vertices::Vertices;
use crate::grid::{Mask, Size};

/// Most texels of a normal map along its longer side; finer grids are averaged.
const LONGEST: usize = 4096;

/// Texels of a normal map: one a cell, as far as that goes.
fn texels(grid: Size) -> Size {
    let longer = grid.columns.max(grid.rows);
    let scaled = |side: usize| (side * LONGEST.min(longer) / longer).max(1);
    Size { columns: scaled(grid.columns), rows: scaled(grid.rows) }
}

/// The normal map as a PNG file.
pub(super) fn normal_png(mesh: &Tin, vertices: &Vertices, slopes: &Slopes, land: Option<&Mask>) -> Vec<u8> {
    let size = texels(slopes.east.size());
    let sampling = Sampling::new(slopes, land, size);
    plain_png(size, &normal_map(mesh, vertices, &sampling))
}

/// Numbers, not colours: without the mark of a colour space.
fn plain_png(size: Size, rgb: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.columns as u32, size.rows as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().expect("writing to memory cannot fail");
    writer.write_image_data(rgb).expect("the buffer holds all texels");
    writer.finish().expect("writing to memory cannot fail");
    bytes
}
