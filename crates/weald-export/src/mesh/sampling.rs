//! Slopes of the ground at the texels of a texture.
//!
//! Between the centres of cells slopes go over linearly. Where a texel is wider than a cell, it is the mean under a
//! tent as wide as two texels. Cells without data do not take part.

use super::delaunay::Point;
use super::slopes::Slopes;
use weald_core::grid::{Mask, Size};

/// Slopes at texels.
#[derive(Debug)]
pub(super) struct Sampling<'a> {
    /// Texels across and down.
    pub(super) texels: Size,
    grid: Size,
    slopes: &'a Slopes,
    valid: Option<&'a Mask>,
    across: Vec<Vec<(usize, f64)>>,
    down: Vec<Vec<(usize, f64)>>,
}

impl<'a> Sampling<'a> {
    /// Slopes on a texture that covers the grid.
    pub(super) fn new(slopes: &'a Slopes, valid: Option<&'a Mask>, texels: Size) -> Self {
        let grid = slopes.east.size();
        let axis = |texels: usize, cells: usize| (0..texels).map(|at| weights(at, texels, cells)).collect();
        let (across, down) = (axis(texels.columns, grid.columns), axis(texels.rows, grid.rows));
        Self { texels, grid, slopes, valid, across, down }
    }

    /// Rise eastward and southward at a texel, in metres per metre; level far from all data.
    pub(super) fn slopes(&self, x: usize, y: usize) -> [f64; 2] {
        let mut sums = [0.0; 3];
        for &(row, down) in &self.down[y] {
            for &(column, across) in &self.across[x] {
                if self.valid.is_none_or(|valid| valid.is_valid(column, row)) {
                    let weight = across * down;
                    sums[0] += weight * f64::from(self.slopes.east.at(column, row));
                    sums[1] += weight * f64::from(self.slopes.south.at(column, row));
                    sums[2] += weight;
                }
            }
        }
        let [east, south, weight] = sums;
        if weight > 0.0 { [east / weight, south / weight] } else { [0.0; 2] }
    }

    /// Where the centre of a cell lies, counted in texels from the centre of the first.
    pub(super) fn texel_of(&self, [x, y]: Point) -> [f64; 2] {
        let scaled =
            |at: u32, texels: usize, cells: usize| (f64::from(at) + 0.5) * texels as f64 / cells as f64 - 0.5;
        [scaled(x, self.texels.columns, self.grid.columns), scaled(y, self.texels.rows, self.grid.rows)]
    }
}

/// Cells near a texel and their weights along one axis.
fn weights(texel: usize, texels: usize, cells: usize) -> Vec<(usize, f64)> {
    let cells_per_texel = cells as f64 / texels as f64;
    let radius = cells_per_texel.max(1.0);
    let centre = ((texel as f64 + 0.5) * cells_per_texel - 0.5).clamp(0.0, cells as f64 - 1.0);
    let first = (centre - radius).ceil().max(0.0) as usize;
    let last = ((centre + radius).floor() as usize).min(cells - 1);
    let weight = |cell: usize| 1.0 - (cell as f64 - centre).abs() / radius;
    (first..=last).map(|cell| (cell, weight(cell))).filter(|&(_, weight)| weight > 0.0).collect()
}
