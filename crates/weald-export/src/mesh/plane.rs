//! The plane of a triangle over the grid.

use super::delaunay::Point;

/// Heights on a plane, by column and row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    column: f64,
    row: f64,
    height: f64,
    /// Rise by the column.
    pub(super) east: f64,
    /// Rise by the row.
    pub(super) south: f64,
}

impl Plane {
    /// The plane through three points that are not on one line.
    pub(super) fn through([a, b, c]: [(Point, f32); 3]) -> Self {
        let offset = |(point, height): (Point, f32)| {
            let [x, y] = [0, 1].map(|axis| f64::from(point[axis]) - f64::from(a.0[axis]));
            (x, y, f64::from(height) - f64::from(a.1))
        };
        let ((bx, by, bz), (cx, cy, cz)) = (offset(b), offset(c));
        let area = bx * cy - by * cx;
        Self {
            column: f64::from(a.0[0]),
            row: f64::from(a.0[1]),
            height: f64::from(a.1),
            east: (bz * cy - cz * by) / area,
            south: (bx * cz - cx * bz) / area,
        }
    }

    /// Height at the centre of a cell.
    #[inline]
    pub(super) fn at(&self, column: usize, row: usize) -> f64 {
        self.between([column as f64, row as f64])
    }

    /// Height at a place between centres, by column and row.
    #[inline]
    pub(super) fn between(&self, [column, row]: [f64; 2]) -> f64 {
        self.height + self.east * (column - self.column) + self.south * (row - self.row)
    }
}
