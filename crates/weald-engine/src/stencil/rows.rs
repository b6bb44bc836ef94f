//! The state of a simulation in memory: rows one after another, each holding one segment of every plane, so
//! that a sweep over rows reads and writes one stretch of memory.

use rayon::prelude::*;

use super::segment::{here, here_mut, stride};

/// How the planes of one row lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Cells in a row.
    pub columns: usize,
    /// Planes in a row.
    pub planes: usize,
}

impl Layout {
    /// Length of a whole row of planes.
    pub fn row_length(self) -> usize {
        stride(self.columns) * self.planes
    }

    /// The cells of a plane within a row of planes.
    pub fn plane(self, row: &[f32], plane: usize) -> &[f32] {
        here(&row[plane * stride(self.columns)..], self.columns)
    }

    /// The cells of a plane within a row of planes.
    pub fn plane_mut(self, row: &mut [f32], plane: usize) -> &mut [f32] {
        here_mut(&mut row[plane * stride(self.columns)..], self.columns)
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
        let rows = (0..self.count()).into_par_iter();
        first_not_finite(rows, planes, |y, plane| self.plane(y, plane))
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

/// Column, row and plane of the first value that is a NaN or an infinity, over the first `planes` planes of some rows;
/// `cells` gives a row of a plane.
pub(crate) fn first_not_finite<'a>(
    rows: impl IndexedParallelIterator<Item = usize>,
    planes: usize,
    cells: impl Fn(usize, usize) -> &'a [f32] + Sync,
) -> Option<[usize; 3]> {
    // A fold over all cells, rather than a search, is what the compiler turns into vector code.
    let finite = |row: &[f32]| row.iter().fold(true, |all, value| all & value.is_finite());
    let wrong = |y: usize| (0..planes).find(|&plane| !finite(cells(y, plane))).map(|plane| (y, plane));
    // A session looks after every few steps, so that one thread alone would be waited for.
    let (y, plane) = rows.map(wrong).find_first(Option::is_some)??;
    let x = cells(y, plane).iter().position(|value| !value.is_finite())?;
    Some([x, y, plane])
}
