//! The state of a simulation in memory: rows one after another, each holding one segment of every plane, so
//! that a sweep over rows reads and writes one stretch of memory.

use rayon::prelude::*;

use super::ring::{here, here_mut, segment};

/// How the planes of one row lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Cells in a row.
    pub columns: usize,
    /// Planes in a row.
    pub planes: usize,
}

impl Layout {
    /// Distance of two planes of one row. Segments that share an offset within a 4 KiB page would make the
    /// processor take a load for a later store's neighbour and wait, so they are kept apart.
    fn plane_stride(self) -> usize {
        const PAGE: usize = 1024;
        const APART: usize = 64;
        let segment = segment(self.columns);
        let offset = segment % PAGE;
        if (APART..=PAGE - APART).contains(&offset) { segment } else { segment + 2 * APART }
    }

    /// Length of a whole row of planes.
    pub fn row_length(self) -> usize {
        self.plane_stride() * self.planes
    }

    /// The cells of a plane within a row of planes.
    pub fn plane(self, row: &[f32], plane: usize) -> &[f32] {
        here(&row[plane * self.plane_stride()..], self.columns)
    }

    /// The cells of a plane within a row of planes.
    pub fn plane_mut(self, row: &mut [f32], plane: usize) -> &mut [f32] {
        here_mut(&mut row[plane * self.plane_stride()..], self.columns)
    }
}

/// A stretch of rows of planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// How each row lies in memory.
    pub layout: Layout,
    /// The rows, one after the other.
    pub memory: Vec<f32>,
}

impl Rows {
    /// So many rows of zeros.
    pub fn new(layout: Layout, rows: usize) -> Self {
        Self { layout, memory: vec![0.0; layout.row_length() * rows] }
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.memory.len() / self.layout.row_length()
    }

    /// Row `y` with all its planes.
    pub fn row(&self, y: usize) -> &[f32] {
        let length = self.layout.row_length();
        &self.memory[y * length..][..length]
    }

    /// Row `y` of one plane.
    pub fn plane(&self, y: usize, plane: usize) -> &[f32] {
        self.layout.plane(self.row(y), plane)
    }

    /// Row `y` of one plane.
    pub fn plane_mut(&mut self, y: usize, plane: usize) -> &mut [f32] {
        let length = self.layout.row_length();
        self.layout.plane_mut(&mut self.memory[y * length..][..length], plane)
    }

    /// Column, row and plane of the first value that is a NaN or an infinity, over the first `planes` planes.
    pub fn first_not_finite(&self, planes: usize) -> Option<[usize; 3]> {
        first_not_finite(self.layout, self.memory.chunks_exact(self.layout.row_length()), planes)
    }

    /// A copy of one plane, row-major without padding.
    pub fn gather(&self, plane: usize) -> Vec<f32> {
        (0..self.count()).flat_map(|y| self.plane(y, plane).iter().copied()).collect()
    }

    /// Sets one plane from row-major values without padding.
    pub fn scatter(&mut self, plane: usize, values: &[f32]) {
        for (y, row) in values.chunks_exact(self.layout.columns).enumerate() {
            self.plane_mut(y, plane).copy_from_slice(row);
        }
    }
}

/// Column, row and plane of the first value that is a NaN or an infinity, over the first `planes` planes.
pub fn first_not_finite<'a>(
    layout: Layout,
    rows: impl Iterator<Item = &'a [f32]>,
    planes: usize,
) -> Option<[usize; 3]> {
    // A fold over all cells, rather than a search, is what the compiler turns into vector code.
    let finite = |row: &[f32]| row.iter().fold(true, |all, value| all & value.is_finite());
    let wrong = |row: &[f32]| (0..planes).find(|&plane| !finite(layout.plane(row, plane)));
    // A session looks after every few steps, so that one thread alone would be waited for.
    let rows: Vec<_> = rows.collect();
    let y = rows.par_iter().position_first(|row| wrong(row).is_some())?;
    let plane = wrong(rows[y])?;
    let x = layout.plane(rows[y], plane).iter().position(|value| !value.is_finite())?;
    Some([x, y, plane])
}
