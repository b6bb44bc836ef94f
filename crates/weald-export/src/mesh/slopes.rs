//! Slopes of the ground at the centres of cells, and normals from them.
//!
//! Central differences, `∂h/∂x = (h(x+1) - h(x-1)) / 2 cell`; one-sided where only one neighbour has data.

use rayon::prelude::*;

use super::delaunay::Point;
use weald_core::grid::{Field, Mask};

/// Rise of the ground in metres per metre.
#[derive(Debug)]
pub(super) struct Slopes {
    /// Eastward.
    pub(super) east: Field,
    /// Southward.
    pub(super) south: Field,
}

impl Slopes {
    /// Slopes of heights on cells of `cell` metres; 0 where there is no data.
    pub(super) fn of(height: &Field, valid: Option<&Mask>, cell: f64) -> Self {
        let size = height.size();
        let is_valid = |x: usize, y: usize| valid.is_none_or(|valid| valid.is_valid(x, y));
        let rise = |[ax, ay]: [usize; 2], [bx, by]: [usize; 2]| {
            let cells = (bx - ax) + (by - ay);
            let rise = f64::from(height.at(bx, by)) - f64::from(height.at(ax, ay));
            if cells == 0 { 0.0 } else { (rise / (cells as f64 * cell)) as f32 }
        };
        let east = |x: usize, y: usize| {
            let west = if x > 0 && is_valid(x - 1, y) { x - 1 } else { x };
            let east = if x + 1 < size.columns && is_valid(x + 1, y) { x + 1 } else { x };
            rise([west, y], [east, y])
        };
        let south = |x: usize, y: usize| {
            let north = if y > 0 && is_valid(x, y - 1) { y - 1 } else { y };
            let south = if y + 1 < size.rows && is_valid(x, y + 1) { y + 1 } else { y };
            rise([x, north], [x, south])
        };
        let field = |slope: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            let rows = (0..size.rows).into_par_iter();
            let at = |x, y| if is_valid(x, y) { slope(x, y) } else { 0.0 };
            let values = rows.flat_map_iter(|y| (0..size.columns).map(move |x| at(x, y))).collect();
            Field::from_values(size, values)
        };
        Self { east: field(&east), south: field(&south) }
    }

    /// The unit normal at a cell, in the axes of a mesh: east, up, south.
    pub(super) fn normal(&self, [x, y]: Point) -> [f64; 3] {
        let (x, y) = (x as usize, y as usize);
        normal(f64::from(self.east.at(x, y)), f64::from(self.south.at(x, y)))
    }
}

/// The unit normal of ground that rises so much eastward and southward, in the axes of a mesh: east, up, south.
pub(super) fn normal(east: f64, south: f64) -> [f64; 3] {
    let length = (1.0 + east * east + south * south).sqrt();
    [-east / length, 1.0 / length, -south / length]
}
