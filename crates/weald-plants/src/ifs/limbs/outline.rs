//! The outline of a fractal: how far it reaches to both sides of its axis at each height.

use crate::ifs::foliage::Shape;
use crate::ifs::game::Game;
use crate::ifs::system::Ifs;

/// Heights at which it is known.
const ROWS: usize = 32;

/// Points that are looked at.
const POINTS: u64 = 60_000;

/// Share of the points of a row that lie outside on each side.
const STRAY: f64 = 0.04;

/// Sides of a shape that is one unit high, from the front and from its right.
pub(super) struct Outline {
    views: Vec<[[f64; 2]; ROWS]>,
}

impl Outline {
    pub(super) fn of(ifs: &Ifs, shape: &Shape) -> Self {
        let axes: &[usize] = if ifs.is_planar() { &[0] } else { &[0, 2] };
        let mut found = vec![vec![Vec::new(); ROWS]; axes.len()];
        Game::new(ifs, 1).points(POINTS, |block| {
            for number in 0..block.len() {
                let flat = shape.flat(block.point(number).map(f64::from));
                let row = ((flat[1] * ROWS as f64) as usize).min(ROWS - 1);
                for (rows, &axis) in found.iter_mut().zip(axes) {
                    rows[row].push(flat[axis]);
                }
            }
        });
        Self { views: found.into_iter().map(sides).collect() }
    }

    /// Views from which it is known.
    pub(super) fn views(&self) -> usize {
        self.views.len()
    }

    /// The share of the height at which a leaf is broadest, or nearly.
    pub(super) fn broadest(&self) -> f64 {
        let width = |row: &usize| {
            let [left, right] = self.views[0][*row];
            right - left
        };
        let broadest = (0..ROWS).max_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or(0);
        ((broadest as f64 + 0.5) / ROWS as f64).clamp(0.2, 0.8)
    }

    /// The sides at a share of the height, in a view.
    pub(super) fn at(&self, view: usize, along: f64) -> [f64; 2] {
        let place = (along * ROWS as f64 - 0.5).clamp(0.0, (ROWS - 1) as f64);
        let row = (place as usize).min(ROWS - 2);
        let (t, rows) = (place - row as f64, &self.views[view]);
        [0, 1].map(|side| rows[row][side] * (1.0 - t) + rows[row + 1][side] * t)
    }
}

/// The sides of each row; those without points have the sides of the row below.
fn sides(rows: Vec<Vec<f64>>) -> [[f64; 2]; ROWS] {
    let mut sides = [[0.0; 2]; ROWS];
    for (row, mut points) in rows.into_iter().enumerate() {
        points.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| points.get((share * points.len() as f64) as usize).copied();
        let before = if row == 0 { [0.0; 2] } else { sides[row - 1] };
        sides[row] = [at(STRAY).unwrap_or(before[0]), at(1.0 - STRAY).unwrap_or(before[1])];
    }
    sides
}
