//! Images inside a mesh file.

use png::{BitDepth, ColorType};

use super::normal_map::normal_map;
use super::sampling::Sampling;
use super::slopes::Slopes;
use super::tin::Tin;
use super::vertices::Vertices;
use weald_core::grid::{Mask, Size};
use weald_io::png::Pixels;

/// Most texels of a normal map along its longer side; finer grids are averaged.
const LONGEST: usize = 4096;

/// Texels of a normal map: one a cell, as far as that goes.
fn texels(grid: Size) -> Size {
    let longer = grid.columns.max(grid.rows);
    let scaled = |side: usize| (side * LONGEST.min(longer) / longer).max(1);
    Size { columns: scaled(grid.columns), rows: scaled(grid.rows) }
}

/// The normal map as a PNG file.
pub(super) fn normal_png(mesh: &Tin, vertices: &Vertices, slopes: &Slopes, valid: Option<&Mask>) -> Vec<u8> {
    let size = texels(slopes.east.size());
    let sampling = Sampling::new(slopes, valid, size);
    let bytes = &normal_map(mesh, vertices, &sampling);
    let sides = [size.columns, size.rows];
    let texels = Pixels { sides, channels: ColorType::Rgb, depth: BitDepth::Eight, bytes };
    texels.file().expect("the buffer holds all texels")
}
