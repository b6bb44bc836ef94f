//! A rectangle of a state, to be read, changed and put back without the rest.

use crate::device::Window;
use crate::stencil::rows::{Layout, Rows};
use crate::sums::RowSums;
use weald_core::error::Error;

/// A state of which a rectangle can be read and changed without the rest.
pub trait Patched {
    /// A copy of all planes over a rectangle.
    ///
    /// # Errors
    /// [`Error::Device`] where it cannot be read from the device that holds it.
    fn patch(&mut self, window: &Window) -> Result<Patch, Error>;

    /// Puts the planes of a patch over those of the state, and its sums in place of those of the first row.
    ///
    /// # Errors
    /// As [`Patched::patch`].
    fn lay(&mut self, patch: &Patch) -> Result<(), Error>;
}

/// Some planes of a state over a rectangle of its cells, and the sums that go with them.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Where it lies.
    pub window: Window,
    /// Numbers of the planes of the state that it holds, in the order of those of `rows`.
    pub planes: Vec<usize>,
    /// Their values.
    pub rows: Rows,
    /// Sums of the first row of the whole state: what a person gives and takes is counted there.
    pub sums: RowSums,
}

impl Patch {
    /// All planes of a state over a window; `cells` gives a row of it and of a plane.
    pub fn cut<'a>(
        planes: usize,
        window: &Window,
        sums: RowSums,
        cells: impl Fn(usize, usize) -> &'a [f32],
    ) -> Self {
        let inside = Layout { columns: window.columns.len(), planes };
        let mut rows = Rows::new(inside, window.rows.len());
        for (y, from) in window.rows.clone().enumerate() {
            for plane in 0..planes {
                let cells = &cells(from, plane)[window.columns.clone()];
                rows.plane_mut(y, plane).copy_from_slice(cells);
            }
        }
        Self { window: window.clone(), planes: (0..planes).collect(), rows, sums }
    }

    /// Puts all rows into a state, of which `put` is handed the row, the plane, the first column and the cells.
    pub fn put(&self, mut put: impl FnMut(usize, usize, usize, &[f32])) {
        for (y, row) in self.window.rows.clone().enumerate() {
            for (from, &plane) in self.planes.iter().enumerate() {
                put(row, plane, self.window.columns.start, self.rows.plane(y, from));
            }
        }
    }

    /// The planes of the state in which another patch over the same window differs.
    pub fn differs(&self, other: &Self) -> Vec<usize> {
        let rows = 0..self.rows.count();
        let bits = |row: &[f32], other: &[f32]| {
            row.iter().map(|v| v.to_bits()).eq(other.iter().map(|v| v.to_bits()))
        };
        let same = |at: usize| rows.clone().all(|y| bits(self.rows.plane(y, at), other.rows.plane(y, at)));
        (0..self.planes.len()).filter(|&at| !same(at)).map(|at| self.planes[at]).collect()
    }

    /// The same with some of its planes alone.
    #[must_use]
    pub fn only(&self, planes: &[usize]) -> Self {
        let kept: Vec<_> = (0..self.planes.len()).filter(|&at| planes.contains(&self.planes[at])).collect();
        let layout = Layout { planes: kept.len(), ..self.rows.layout };
        let mut rows = Rows::new(layout, self.window.rows.len());
        for y in 0..self.window.rows.len() {
            for (into, &from) in kept.iter().enumerate() {
                rows.plane_mut(y, into).copy_from_slice(self.rows.plane(y, from));
            }
        }
        let planes = kept.iter().map(|&at| self.planes[at]).collect();
        Self { window: self.window.clone(), planes, rows, sums: self.sums }
    }

    /// Memory that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.rows.memory.as_slice())
    }
}
