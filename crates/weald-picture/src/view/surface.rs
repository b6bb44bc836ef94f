//! A field as a smooth surface over the ground: the uniform cubic B-spline of its cells, at any place.
//!
//! `B(t) = ((1-t)³, 3t³-6t²+4, -3t³+3t²+3t+1, t³) / 6`, as in the relief picture: its second derivative is
//! continuous, so neither light nor reflections show cells. A patch lies within the range of its four by four
//! control points, which is what the pyramid of maxima rests on. Beyond the border the control points go on by
//! point reflection.
//!
//! Places are counted in cells, half a cell more than from the outer corner: the landscape is the rectangle
//! from 0.5 to columns + 0.5, and the whole part of a place is its patch. Where the ground is drawn on finer cells than a
//! field has, places are counted in those, and the field's surface says how many of its own each is.

use rayon::prelude::*;
use weald_core::grid::{Field, Size};

/// Control points beyond each border.
const RIM: usize = 2;

/// A smooth surface.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    /// Cells without the rim.
    size: Size,
    stride: usize,
    pub(super) control: Vec<f32>,
    /// Cells of the field in a cell by which places are counted.
    scale: f32,
}

/// Weights of four successive control points.
#[inline(always)]
fn weights(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    let sixth = 1.0 / 6.0;
    [
        s * s * s * sixth,
        ((3.0 * t - 6.0) * t * t + 4.0) * sixth,
        (((3.0 - 3.0 * t) * t + 3.0) * t + 1.0) * sixth,
        t * t * t * sixth,
    ]
}

/// The same for the derivative.
#[inline(always)]
fn slopes(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [-0.5 * s * s, (1.5 * t - 2.0) * t, (1.0 - 1.5 * t) * t + 0.5, 0.5 * t * t]
}

/// Weights of the cubic convolution.
fn keys(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [-0.5 * t * s * s, 1.0 + t * t * (1.5 * t - 2.5), 1.0 + s * s * (1.5 * s - 2.5), -0.5 * s * t * t]
}

/// The sum of each row, weighed.
#[inline(always)]
fn sums(weights: &[f32; 4], [a, b, c, d]: &[&[f32]; 4]) -> [f32; 4] {
    [sum(weights, a), sum(weights, b), sum(weights, c), sum(weights, d)]
}

#[inline(always)]
fn sum(weights: &[f32; 4], row: &[f32]) -> f32 {
    (weights[0] * row[0] + weights[1] * row[1]) + (weights[2] * row[2] + weights[3] * row[3])
}

impl Surface {
    /// The surface of a field.
    pub(super) fn new(field: &Field) -> Self {
        let size = field.size();
        let stride = size.columns + 2 * RIM;
        let mut control = vec![0.0; stride * (size.rows + 2 * RIM)];
        let down = |y: usize| Reflection::of(y, size.rows);
        control.par_chunks_mut(stride).enumerate().for_each(|(y, row)| fill_row(row, field, &down(y)));
        Self { size, stride, control, scale: 1.0 }
    }

    /// The same surface for places that are counted in cells of which each of its own holds so many along a side.
    #[must_use]
    pub(super) fn on_finer(self, fineness: usize) -> Self {
        Self { scale: 1.0 / fineness as f32, ..self }
    }

    /// Columns and rows of the field.
    pub(super) fn size(&self) -> Size {
        self.size
    }

    /// Columns and rows of the control points.
    pub(super) fn controls(&self) -> [usize; 2] {
        [self.stride, self.size.rows + 2 * RIM]
    }

    /// Columns and rows of the patches.
    pub(super) fn patches(&self) -> [usize; 2] {
        [self.size.columns + 1, self.size.rows + 1]
    }

    /// The rows of four control points of a patch.
    #[inline(always)]
    pub(super) fn patch(&self, x: usize, y: usize) -> [&[f32]; 4] {
        // Not `map`, which is not inlined everywhere.
        let start = y * self.stride + x;
        let row = |row: usize| &self.control[start + row * self.stride..][..4];
        [row(0), row(1), row(2), row(3)]
    }

    #[inline(always)]
    fn locate(&self, place: [f32; 2]) -> ([usize; 2], [f32; 2]) {
        let [columns, rows] = self.patches();
        let place = place.map(|at| 0.5 + (at - 0.5) * self.scale);
        let x = (place[0].max(0.0) as usize).min(columns - 1);
        let y = (place[1].max(0.0) as usize).min(rows - 1);
        ([x, y], [(place[0] - x as f32).clamp(0.0, 1.0), (place[1] - y as f32).clamp(0.0, 1.0)])
    }

    /// The value at a place; beyond the landscape that of its border.
    #[inline(always)]
    pub(super) fn at(&self, place: [f32; 2]) -> f32 {
        let ([x, y], [t, s]) = self.locate(place);
        let across = weights(t);
        sum(&weights(s), &sums(&across, &self.patch(x, y)))
    }

    /// The value at a place by the cubic convolution of Keys 1981: it passes through the values of cells, and stays between
    /// those of the four around, which it would overshoot beside cliffs.
    pub(super) fn keys_at(&self, place: [f32; 2]) -> f32 {
        let ([x, y], [t, s]) = self.locate(place);
        let across = keys(t);
        let patch = self.patch(x, y);
        let [a, b, c, d] = [patch[1][1], patch[1][2], patch[2][1], patch[2][2]];
        let [low, high] = [a.min(b).min(c).min(d), a.max(b).max(c).max(d)];
        sum(&keys(s), &sums(&across, &patch)).clamp(low, high)
    }

    /// The value at a place and its rise by the cell of places eastward and southward.
    #[inline(always)]
    pub(super) fn with_slope(&self, place: [f32; 2]) -> [f32; 3] {
        let ([x, y], [t, s]) = self.locate(place);
        let (across, down) = (weights(t), weights(s));
        let patch = self.patch(x, y);
        let rows = sums(&across, &patch);
        let rise = sums(&slopes(t), &patch);
        [sum(&down, &rows), self.scale * sum(&down, &rise), self.scale * sum(&slopes(s), &rows)]
    }
}

/// Where a row of finer cells lies on the surface of a field: for each cell the first of its four columns of control points,
/// and their weights.
pub(super) struct FinerCells {
    fineness: usize,
    columns: Vec<FinerColumn>,
}

struct FinerColumn {
    first: usize,
    weights: [f32; 4],
    slopes: [f32; 4],
}

/// Values along a row of finer cells, and their rises by the cell of the field.
pub(super) struct FinerRow {
    control: [Vec<f32>; 2],
}

impl FinerCells {
    /// So many finer cells along the side of each of a surface.
    pub(super) fn of(surface: &Surface, fineness: usize) -> Self {
        let column = |x: usize| {
            let ([first, _], [t, _]) = surface.locate([middle(x, fineness), 1.0]);
            FinerColumn { first, weights: weights(t), slopes: slopes(t) }
        };
        Self { fineness, columns: (0..surface.size.columns * fineness).map(column).collect() }
    }

    /// A row of a surface, of as many columns as that of these cells.
    pub(super) fn row(&self, surface: &Surface, y: usize) -> FinerRow {
        let ([_, first], [_, s]) = surface.locate([1.0, middle(y, self.fineness)]);
        let rows =
            [0, 1, 2, 3].map(|row| &surface.control[(first + row) * surface.stride..][..surface.stride]);
        let down = |w: [f32; 4]| {
            let above = rows[0].iter().zip(rows[1]).map(|(a, b)| w[0] * a + w[1] * b);
            let below = rows[2].iter().zip(rows[3]).map(|(a, b)| w[2] * a + w[3] * b);
            above.zip(below).map(|(a, b)| a + b).collect()
        };
        FinerRow { control: [down(weights(s)), down(slopes(s))] }
    }

    /// The value of a row at a column.
    #[inline(always)]
    pub(super) fn at(&self, row: &FinerRow, x: usize) -> f32 {
        let FinerColumn { first, weights, .. } = &self.columns[x];
        sum(weights, &row.control[0][*first..*first + 4])
    }

    /// The same, and its rise by the cell of the field eastward and southward.
    pub(super) fn with_slope(&self, row: &FinerRow, x: usize) -> [f32; 3] {
        let FinerColumn { first, weights, slopes } = &self.columns[x];
        let [values, rises] = [0, 1].map(|of| &row.control[of][*first..*first + 4]);
        [sum(weights, values), sum(slopes, values), sum(weights, rises)]
    }
}

/// The place of the middle of a finer cell.
pub(super) fn middle(cell: usize, fineness: usize) -> f32 {
    0.5 + (cell as f32 + 0.5) / fineness as f32
}

/// The control points of a row, which is made of rows of the field as is said.
fn fill_row(row: &mut [f32], field: &Field, down: &Reflection) {
    let columns = field.size().columns;
    let of_field = |y: usize| &field.values()[y * columns..(y + 1) * columns];
    let (edge, inside) = (of_field(down.edge), of_field(down.inside));
    for ((control, edge), inside) in row[RIM..].iter_mut().zip(edge).zip(inside) {
        *control = edge + down.beyond * (edge - inside);
    }
    for x in (0..RIM).chain(RIM + columns..row.len()) {
        row[x] = Reflection::of(x, columns).of_values(|column| row[RIM + column]);
    }
}

/// What a control point beyond the border is made of: its border cell and what lies as far inside of that.
struct Reflection {
    edge: usize,
    inside: usize,
    /// How many times as far outside it is as the cell inside; 0 within the field.
    beyond: f32,
}

impl Reflection {
    fn of(place: usize, count: usize) -> Self {
        let last = count as isize - 1;
        let cell = place as isize - RIM as isize;
        let edge = cell.clamp(0, last);
        let inside = (2 * edge - cell).clamp(0, last);
        let beyond = if inside == edge { 0.0 } else { (cell - edge) as f32 / (edge - inside) as f32 };
        Self { edge: edge as usize, inside: inside as usize, beyond }
    }

    fn of_values(&self, value: impl Fn(usize) -> f32) -> f32 {
        let edge = value(self.edge);
        edge + self.beyond * (edge - value(self.inside))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_plane_is_a_plane_up_to_the_border_whatever_the_size() {
        for (columns, rows) in [(2, 2), (3, 7), (40, 5)] {
            let size = Size::new(columns, rows).expect("small");
            let surface = Surface::new(&Field::from_function(size, |x, y| 3.0 * x as f32 - 2.0 * y as f32));
            for step in 0..=20 {
                let place = [0.5 + columns as f32 * step as f32 / 20.0, 0.5 + rows as f32 * 0.3];
                let [value, east, south] = surface.with_slope(place);
                let expected = 3.0 * (place[0] - 1.0) - 2.0 * (place[1] - 1.0);
                assert!((value - expected).abs() < 1e-3, "{columns} × {rows}: {value} for {expected}");
                assert!((east - 3.0).abs() < 1e-3 && (south + 2.0).abs() < 1e-3);
                assert_eq!(value, surface.at(place));
            }
        }
    }

    #[test]
    fn on_finer_cells_a_surface_is_the_same_and_rises_less_by_the_cell() {
        let size = Size::new(9, 7).expect("small");
        let field = Field::from_function(size, |x, y| ((x * 7 + y * 5) % 11) as f32);
        let (coarse, fine) = (Surface::new(&field), Surface::new(&field).on_finer(4));
        for step in 0..50 {
            let place = [0.6 + 0.17 * step as f32, 0.7 + 0.12 * step as f32];
            let there = place.map(|at| 0.5 + 4.0 * (at - 0.5));
            let ([a, east, south], [b, less_east, less_south]) =
                (coarse.with_slope(place), fine.with_slope(there));
            assert!((a - b).abs() < 1e-4, "{a} and {b}");
            assert!((east - 4.0 * less_east).abs() < 1e-3 && (south - 4.0 * less_south).abs() < 1e-3);
        }
    }

    #[test]
    fn the_convolution_does_not_overshoot_a_cliff() {
        let size = Size::new(12, 5).expect("small");
        let surface = Surface::new(&Field::from_function(size, |x, _| if x < 6 { 0.0 } else { 80.0 }));
        for step in 0..200 {
            let value = surface.keys_at([1.0 + 0.05 * step as f32, 2.3]);
            assert!((-1e-3..=80.001).contains(&value), "{value} at {step}");
        }
    }

    #[test]
    fn rows_of_finer_cells_are_the_surface_at_their_middles() {
        let size = Size::new(9, 7).expect("small");
        let surface = Surface::new(&Field::from_function(size, |x, y| ((x * 7 + y * 5) % 11) as f32));
        for fineness in [1, 2, 3, 4] {
            let cells = FinerCells::of(&surface, fineness);
            for y in 0..7 * fineness {
                let row = cells.row(&surface, y);
                for x in 0..9 * fineness {
                    let there = surface.with_slope([middle(x, fineness), middle(y, fineness)]);
                    let here = cells.with_slope(&row, x);
                    assert!(
                        here.iter().zip(there).all(|(a, b)| (a - b).abs() < 1e-4),
                        "{here:?} for {there:?}"
                    );
                    assert_eq!(here[0], cells.at(&row, x));
                }
            }
        }
    }

    proptest! {
        #[test]
        fn a_patch_stays_within_its_control_points(heights in prop::collection::vec(-9.0_f32..9.0, 30), t in 0.0_f32..1.0, s in 0.0_f32..1.0) {
            let size = Size::new(6, 5).expect("small");
            let surface = Surface::new(&Field::from_values(size, heights));
            for y in 0..6 {
                for x in 0..7 {
                    let points = surface.patch(x, y).concat();
                    let (low, high) = points.iter().fold((f32::MAX, f32::MIN), |(low, high), &p| (low.min(p), high.max(p)));
                    let value = surface.at([x as f32 + t, y as f32 + s]);
                    prop_assert!(value >= low - 1e-4 && value <= high + 1e-4, "{value} outside {low} to {high}");
                }
            }
        }
    }
}
