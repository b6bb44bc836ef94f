//! Smooth values and slopes between the cells of a grid, by the uniform cubic B-spline.
//!
//! `B(t) = ((1-t)³, 3t³-6t²+4, -3t³+3t²+3t+1, t³) / 6` over the four nearest cells of each axis. Its second
//! derivative is continuous, so shading shows neither cells nor creases, and it never overshoots. On cell
//! centres its slope is the central difference. Beyond the border the grid goes on by point reflection,
//! which keeps a plane a plane.

use super::sheet::Sheet;
use weald_core::grid::Field;

/// Weights of four successive cells for a value and for its derivative by the cell.
#[derive(Clone, Copy, Debug, Default)]
struct Taps {
    first: usize,
    value: [f32; 4],
    slope: [f32; 4],
}

impl Taps {
    /// Weights at `position` in cells, -0.5 to `count` - 0.5.
    fn at(position: f64, count: usize) -> Self {
        let start = position.floor();
        let t = position - start;
        let value =
            [cube(1.0 - t), (3.0 * t - 6.0) * t * t + 4.0, ((3.0 - 3.0 * t) * t + 3.0) * t + 1.0, cube(t)];
        let slope =
            [-3.0 * (1.0 - t) * (1.0 - t), (9.0 * t - 12.0) * t, (6.0 - 9.0 * t) * t + 3.0, 3.0 * t * t];
        let mut taps = Self {
            first: (start as usize).saturating_sub(1).min(count.saturating_sub(4)),
            ..Self::default()
        };
        for (offset, (value, slope)) in (-1..).zip(value.into_iter().zip(slope)) {
            taps.add(start as isize + offset, count, value / 6.0, slope / 6.0);
        }
        taps
    }

    fn add(&mut self, cell: isize, count: usize, value: f64, slope: f64) {
        let last = count as isize - 1;
        let inside = cell.clamp(0, last);
        if cell == inside {
            return self.add_inside(cell, value, slope);
        }
        let mirrored = (2 * inside - cell).clamp(0, last);
        self.add_inside(inside, 2.0 * value, 2.0 * slope);
        self.add_inside(mirrored, -value, -slope);
    }

    fn add_inside(&mut self, cell: isize, value: f64, slope: f64) {
        let place = cell as usize - self.first;
        self.value[place] += value as f32;
        self.slope[place] += slope as f32;
    }
}

fn cube(x: f64) -> f64 {
    x * x * x
}

/// Weights for every column and row of a sheet.
#[derive(Debug)]
pub(super) struct Spline {
    across: Vec<Taps>,
    down: Vec<Taps>,
}

/// Values and slopes along one row of pixels.
#[derive(Debug, Default)]
pub(super) struct SplineRow {
    /// The value at each pixel's centre.
    pub(super) value: Vec<f32>,
    /// Its rise eastward by the cell.
    pub(super) east: Vec<f32>,
    /// Its rise southward by the cell.
    pub(super) south: Vec<f32>,
    mixed: Vec<[f32; 2]>,
}

impl Spline {
    /// Weights for fields of `columns` × `rows` cells on the pixels of `sheet`.
    pub(super) fn new(sheet: &Sheet, columns: usize, rows: usize) -> Self {
        Self { across: axis(sheet.width, columns), down: axis(sheet.height, rows) }
    }

    /// Evaluates `field` along row `y` of the sheet.
    pub(super) fn row(&self, field: &Field, y: usize, row: &mut SplineRow) {
        mix_rows(field, &self.down[y], &mut row.mixed);
        let width = self.across.len();
        for part in [&mut row.value, &mut row.east, &mut row.south] {
            part.resize(width, 0.0);
        }
        let outputs = row.value.iter_mut().zip(&mut row.east).zip(&mut row.south);
        for (((value, east), south), taps) in outputs.zip(&self.across) {
            let cells = &row.mixed[taps.first..taps.first + 4];
            (*value, *east, *south) = (0.0, 0.0, 0.0);
            for ((cell, weight), slope) in cells.iter().zip(taps.value).zip(taps.slope) {
                *value += cell[0] * weight;
                *east += cell[0] * slope;
                *south += cell[1] * weight;
            }
        }
    }
}

fn axis(pixels: usize, cells: usize) -> Vec<Taps> {
    let position = |pixel: usize| (pixel as f64 + 0.5) * cells as f64 / pixels as f64 - 0.5;
    (0..pixels).map(|pixel| Taps::at(position(pixel), cells)).collect()
}

/// Value and southward rise above every column, from four rows; padded to four columns.
fn mix_rows(field: &Field, taps: &Taps, mixed: &mut Vec<[f32; 2]>) {
    let size = field.size();
    mixed.clear();
    mixed.resize(size.columns.max(4), [0.0; 2]);
    for (place, (value, slope)) in taps.value.into_iter().zip(taps.slope).enumerate() {
        let y = (taps.first + place).min(size.rows - 1);
        for (mixed, &cell) in mixed.iter_mut().zip(field.row(y)) {
            mixed[0] += value * cell;
            mixed[1] += slope * cell;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::Size;

    fn worst_slope_error(columns: usize, rows: usize) -> f32 {
        let size = Size::new(columns, rows).expect("legal");
        let sheet = Sheet::new(&Domain::new(size, 1.0), Some(57)).expect("legal");
        let field = Field::from_function(size, |x, y| 3.0 * x as f32 - 2.0 * y as f32 + 1.0);
        let (spline, mut row, mut worst) =
            (Spline::new(&sheet, columns, rows), SplineRow::default(), 0.0_f32);
        for y in 0..sheet.height {
            spline.row(&field, y, &mut row);
            for x in 0..sheet.width {
                worst = worst.max((row.east[x] - 3.0).abs()).max((row.south[x] + 2.0).abs());
            }
        }
        worst
    }

    #[test]
    fn a_plane_stays_a_plane_up_to_and_beyond_the_border_cells() {
        for (columns, rows) in [(4, 4), (5, 9), (16, 3), (57, 57)] {
            let worst = worst_slope_error(columns, rows);
            assert!(worst < 1e-3, "{columns} × {rows}: slope off by {worst}");
        }
    }
}
