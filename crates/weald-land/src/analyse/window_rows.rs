//! Layers of what the surface around each cell is like, whole rows of 3 × 3 windows in vectors.
//!
//! A window that the edge of the grid or cells without data cut, or one that is wider, is fitted cell by cell.

use super::cells::{fields_by_rows, put};
use super::quadric::{Quadric, Surface};
use weald_core::grid::Field;
use weald_core::vectors::widest;

/// Windows that are fitted together: results go through an array of so many, which nothing else can overlap.
const LANES: usize = 64;

/// Three rows around so many cells: what lies a column west of them, at them and a column east.
type Around<'a> = [[&'a [f32; LANES]; 3]; 3];

impl Surface<'_> {
    /// Fields of what `values` makes of column and row of each cell with data and the surface around it; others hold 0. For the speed of vectors
    /// `values` must be marked `#[inline(always)]`.
    pub(super) fn fields<const N: usize>(
        &self,
        values: impl Fn([usize; 2], Quadric) -> [f64; N] + Sync,
    ) -> [Field; N] {
        let size = self.domain.size;
        let is_inside = |y: usize| y >= 1 && y + 1 < size.rows && size.columns >= LANES + 2;
        fields_by_rows(size, |y, rows| {
            let is_fast = self.radius == 1 && is_inside(y);
            if is_fast {
                self.whole_windows(y, rows, &values);
            }
            self.other_windows(y, is_fast, rows, &values);
        })
    }

    /// A row of windows, as if all of them were whole.
    fn whole_windows<const N: usize>(
        &self,
        y: usize,
        rows: &mut [&mut [f32]; N],
        values: &impl Fn([usize; 2], Quadric) -> [f64; N],
    ) {
        let around = [y - 1, y, y + 1].map(|row| self.height.row(row));
        let last = self.domain.size.columns - 1 - LANES;
        for first in (1..last).step_by(LANES).chain([last]) {
            let lanes = |row: &'_ [f32], at: usize| -> [f32; LANES] {
                *row[at..].first_chunk().expect("as many columns as lanes and two")
            };
            let copied = around.map(|row| [first - 1, first, first + 1].map(|at| lanes(row, at)));
            let around = copied.each_ref().map(<[[f32; LANES]; 3]>::each_ref);
            let mut made = [[0.0; LANES]; N];
            widest(
                #[inline(always)]
                || self.lanes([first, y], &around, &mut made, values),
            );
            for (row, made) in rows.iter_mut().zip(&made) {
                row[first..first + LANES].copy_from_slice(made);
            }
        }
    }

    #[inline(always)]
    fn lanes<const N: usize>(
        &self,
        [first, y]: [usize; 2],
        around: &Around<'_>,
        made: &mut [[f32; LANES]; N],
        values: &impl Fn([usize; 2], Quadric) -> [f64; N],
    ) {
        for lane in 0..LANES {
            let heights = around.map(|row| row.map(|cells| f64::from(cells[lane])));
            let found = values([first + lane, y], self.of_heights(heights));
            for (made, found) in made.iter_mut().zip(found) {
                made[lane] = found as f32;
            }
        }
    }

    /// The windows of a row that are not whole, or all of them; 0 in cells without data.
    fn other_windows<const N: usize>(
        &self,
        y: usize,
        has_whole: bool,
        rows: &mut [&mut [f32]; N],
        values: &impl Fn([usize; 2], Quadric) -> [f64; N],
    ) {
        let columns = self.domain.size.columns;
        let middle = if has_whole && self.has_all_data_around(y) { 1..columns - 1 } else { 0..0 };
        for x in (0..middle.start).chain(middle.end..columns) {
            let has_data = self.domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y));
            if !has_data {
                put(rows, x, [0.0; N]);
            } else if !(has_whole && self.is_whole(x, y)) {
                put(rows, x, values([x, y], self.at(x, y)));
            }
        }
    }

    /// Whether a row and its neighbours have data in all cells.
    fn has_all_data_around(&self, y: usize) -> bool {
        let columns = self.domain.size.columns;
        self.domain.valid.as_ref().is_none_or(|valid| {
            valid.flags()[(y - 1) * columns..(y + 2) * columns].iter().all(|&valid| valid)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Mask, Size};
    use weald_core::random::{hash2, unit};

    /// Rough ground with holes.
    fn ground(columns: usize) -> (Domain, Field) {
        let size = Size::new(columns, 9).expect("small");
        let random = |seed, x: usize, y: usize| unit(hash2(seed, x as i64, y as i64));
        let has_data = |cell: usize| random(1, cell % columns, cell / columns) > 0.02;
        let valid = Mask::new(size, (0..size.cells()).map(has_data).collect());
        let height = Field::from_function(size, |x, y| (100.0 * random(2, x, y)) as f32);
        (Domain { valid, ..Domain::new(size, 12.5) }, height)
    }

    #[test]
    fn rows_of_windows_are_what_each_window_is_alone() {
        for (columns, holes) in [(65, true), (66, true), (67, true), (130, false), (300, true), (300, false)]
        {
            let (domain, height) = ground(columns);
            let domain = if holes { domain } else { Domain { valid: None, ..domain } };
            let surface = Surface::new(&height, &domain);
            let derivatives = |_: [usize; 2], quadric: Quadric| {
                let Quadric { p, q, r, s, t } = quadric;
                [p, q, r, s, t]
            };
            let fields = surface.fields(derivatives);
            for cell in 0..domain.size.cells() {
                let (x, y) = (cell % columns, cell / columns);
                let has_data = domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y));
                let expected = if has_data { derivatives([x, y], surface.at(x, y)) } else { [0.0; 5] };
                for (field, expected) in fields.iter().zip(expected) {
                    let off = (f64::from(field.at(x, y)) - expected).abs();
                    assert!(off <= 1e-6 * expected.abs().max(1e-3), "{off} at {x}, {y} of {columns}");
                }
            }
        }
    }
}
