//! The heights that a mesh is to follow, and how closely.

use super::delaunay::Point;
use weald_core::grid::{Field, Mask, Size};

/// Heights at the centres of cells and the deviation that each cell bears.
#[derive(Debug)]
pub(super) struct Surface<'a> {
    /// Heights in metres.
    pub(super) height: &'a Field,
    /// Cells with data; `None` where all have.
    pub(super) valid: Option<&'a Mask>,
    /// One over the deviation that a cell bears, in metres; 0 in cells without data.
    pub(super) strictness: Field,
}

/// By how much deviations in 32 bits may come out too small.
const ROUNDING: f64 = 1.0 + 1e-6;

impl<'a> Surface<'a> {
    /// A surface to be followed to `error` metres everywhere.
    pub(super) fn new(height: &'a Field, valid: Option<&'a Mask>, error: f64) -> Self {
        Self::bearing(height, valid, |_| error)
    }

    /// A surface each cell of which bears its own deviation, in metres.
    pub(super) fn bearing(height: &'a Field, valid: Option<&'a Mask>, error: impl Fn(usize) -> f64) -> Self {
        let is_valid = |cell: usize| valid.is_none_or(|valid| valid.is_valid_at(cell));
        let strictness = |cell: usize| if is_valid(cell) { (ROUNDING / error(cell)) as f32 } else { 0.0 };
        let strictness = (0..height.size().cells()).map(strictness).collect();
        Self { height, valid, strictness: Field::from_values(height.size(), strictness) }
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> Size {
        self.height.size()
    }

    /// Whether a cell has data.
    pub(super) fn is_valid(&self, [x, y]: Point) -> bool {
        self.valid.is_none_or(|valid| valid.is_valid(x as usize, y as usize))
    }

    /// Height of a cell.
    pub(super) fn at(&self, [x, y]: Point) -> f32 {
        self.height.at(x as usize, y as usize)
    }

    /// Whether a triangle that crosses no shore lies where there is ground.
    ///
    /// Ground is the square between four cells with data, and half of the square of three.
    pub(super) fn is_ground(&self, triangle: [Point; 3]) -> bool {
        // The centroid, in thirds of a cell.
        let [x, y] = [0, 1].map(|axis| triangle.iter().map(|corner| corner[axis]).sum::<u32>());
        let void = |[dx, dy]: &[u32; 2]| !self.is_valid([x / 3 + dx, y / 3 + dy]);
        let mut voids = [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().filter(void);
        match (voids.next(), voids.next()) {
            (None, _) => true,
            (Some([dx, dy]), None) => (x % 3).abs_diff(3 * dx) + (y % 3).abs_diff(3 * dy) > 3,
            _ => false,
        }
    }
}
