//! The state of a simulation in memory: rows one after another, each holding one segment of every plane, so
//! that a sweep over rows reads and writes one stretch of memory.

use super::ring::{here, here_mut, segment};

/// How the planes of one row lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Cells in a row.
    pub(crate) columns: usize,
    /// Planes in a row.
    pub(crate) planes: usize,
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
    pub(crate) fn row_length(self) -> usize {
        self.plane_stride() * self.planes
    }

    /// The cells of a plane within a row of planes.
    pub(crate) fn plane(self, row: &[f32], plane: usize) -> &[f32] {
        here(&row[plane * self.plane_stride()..], self.columns)
    }

    /// The cells of a plane within a row of planes.
    pub(crate) fn plane_mut(self, row: &mut [f32], plane: usize) -> &mut [f32] {
        here_mut(&mut row[plane * self.plane_stride()..], self.columns)
    }
}

/// A stretch of rows of planes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rows {
    pub(crate) layout: Layout,
    pub(crate) memory: Vec<f32>,
}

impl Rows {
    pub(crate) fn new(layout: Layout, rows: usize) -> Self {
        Self { layout, memory: vec![0.0; layout.row_length() * rows] }
    }

    /// Number of rows.
    pub(crate) fn count(&self) -> usize {
        self.memory.len() / self.layout.row_length()
    }

    /// Row `y` with all its planes.
    pub(crate) fn row(&self, y: usize) -> &[f32] {
        let length = self.layout.row_length();
        &self.memory[y * length..][..length]
    }

    /// Row `y` of one plane.
    pub(crate) fn plane(&self, y: usize, plane: usize) -> &[f32] {
        self.layout.plane(self.row(y), plane)
    }

    /// Row `y` of one plane.
    pub(crate) fn plane_mut(&mut self, y: usize, plane: usize) -> &mut [f32] {
        let length = self.layout.row_length();
        self.layout.plane_mut(&mut self.memory[y * length..][..length], plane)
    }

    /// A copy of one plane, row-major without padding.
    pub(crate) fn gather(&self, plane: usize) -> Vec<f32> {
        (0..self.count()).flat_map(|y| self.plane(y, plane).iter().copied()).collect()
    }

    /// Sets one plane from row-major values without padding.
    pub(crate) fn scatter(&mut self, plane: usize, values: &[f32]) {
        for (y, row) in values.chunks_exact(self.layout.columns).enumerate() {
            self.plane_mut(y, plane).copy_from_slice(row);
        }
    }
}
