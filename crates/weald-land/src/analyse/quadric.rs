//! The surface around a cell: a quadratic fitted to the heights of a window by least squares.
//!
//! ```text
//! z(x, y) = ½ r x² + s x y + ½ t y² + p x + q y + u          x east, y north, in metres
//! ```
//!
//! Evans 1972, "General geomorphometry, derivatives of altitude, and descriptive statistics", in Chorley (ed.),
//! Spatial Analysis in Geomorphology, doi 10.4324/9780429273346-2, for 3 × 3 cells; Wood 1996, "The
//! geomorphological characterisation of digital elevation models" (thesis, Leicester), for wider windows.
//! Differs: where the edge of the grid or cells without data cut a piece out of the window, the fit goes through
//! the cells that are there. Where they do not determine a quadratic, the window is widened by up to two cells,
//! and then terms are left out: first those of second order, then the slope across the line of the cells.

use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::Field;

/// Cells to each side of the widest window.
const WIDEST: usize = 32;

/// Cells by which a window is widened at most, where too little of it has data.
const WIDENING: usize = 2;

/// Cells beside the metres of a window that it looks at: the least of it, and those by which it is widened.
pub(super) const LOOKS: usize = 1 + WIDENING;

/// Part of a pivot below which a term counts as not determined. The matrices hold small whole numbers, so that
/// one that is not determined leaves nothing but rounding.
const UNDETERMINED: f64 = 1e-9;

/// Terms of the quadratic.
const TERMS: usize = 6;

/// Derivatives of the surface in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Quadric {
    /// Rise towards the east.
    pub(super) p: f64,
    /// Rise towards the north.
    pub(super) q: f64,
    /// Second derivative from west to east, 1/m.
    pub(super) r: f64,
    /// Mixed derivative, 1/m.
    pub(super) s: f64,
    /// Second derivative from south to north, 1/m.
    pub(super) t: f64,
}

impl Quadric {
    /// Square of the steepest rise.
    #[inline(always)]
    pub(super) fn steepness(&self) -> f64 {
        self.p * self.p + self.q * self.q
    }
}

/// Ground to which windows are fitted.
pub(super) struct Surface<'a> {
    pub(super) height: &'a Field,
    pub(super) domain: &'a Domain,
    /// Cells from the middle of a window to its edge.
    pub(super) radius: usize,
}

/// Cells to each side of a window that reaches so many metres.
///
/// # Errors
/// [`Error::Limit`] where they are more than [`WIDEST`].
pub(super) fn window(domain: &Domain, metres: f64) -> Result<usize, Error> {
    let cell = domain.cell;
    let cells = libm::round(metres / cell).max(1.0);
    if cells <= WIDEST as f64 {
        return Ok(cells as usize);
    }
    let limit = Limit::new(Quantity::WindowCells, cells as u64, 0..=WIDEST as u64);
    let widest = WIDEST as f64 * cell;
    let remedy = format!("blur the ground with a `smooth` step first, or choose at most {widest} m");
    let subject = format!("a window of `scale` = {metres} m in cells of {cell} m");
    Err(limit.of(subject).remedy(remedy).into())
}

impl<'a> Surface<'a> {
    /// Windows of 3 × 3 cells.
    pub(super) fn new(height: &'a Field, domain: &'a Domain) -> Self {
        Self { height, domain, radius: 1 }
    }

    /// Windows that reach so many metres to each side, to the nearest whole number of cells and one at least.
    ///
    /// # Errors
    /// [`Error::Limit`] for windows wider than [`WIDEST`] cells to each side.
    pub(super) fn reaching(self, metres: f64) -> Result<Self, Error> {
        Ok(Self { radius: window(self.domain, metres)?, ..self })
    }

    /// The surface around a cell with data.
    pub(super) fn at(&self, x: usize, y: usize) -> Quadric {
        if self.is_whole(x, y) { self.whole(x, y) } else { self.partial(x, y) }
    }

    /// Whether the window around a cell has all of its cells.
    pub(super) fn is_whole(&self, x: usize, y: usize) -> bool {
        let (size, radius) = (self.domain.size, self.radius);
        let inside = x >= radius && y >= radius && x + radius < size.columns && y + radius < size.rows;
        let rows = y.saturating_sub(radius)..=y + radius;
        let has_data = |row: usize| {
            self.domain.valid.as_ref().is_none_or(|valid| {
                valid.flags()[row * size.columns..][x - radius..=x + radius].iter().all(|&valid| valid)
            })
        };
        inside && rows.into_iter().all(has_data)
    }

    /// Heights of a window above its middle, with their places: cells to the east and to the north.
    fn window(&self, x: usize, y: usize, radius: usize) -> impl Iterator<Item = (f64, f64, f64)> {
        let size = self.domain.size;
        let middle = f64::from(self.height.at(x, y));
        let rows = y.saturating_sub(radius)..(y + radius + 1).min(size.rows);
        let columns = x.saturating_sub(radius)..(x + radius + 1).min(size.columns);
        let cells = rows.flat_map(move |row| columns.clone().map(move |column| (column, row)));
        let valid = self.domain.valid.as_ref();
        cells.filter(move |&(column, row)| valid.is_none_or(|valid| valid.is_valid(column, row))).map(
            move |(column, row)| {
                let height = f64::from(self.height.at(column, row)) - middle;
                (column as f64 - x as f64, y as f64 - row as f64, height)
            },
        )
    }

    /// In a whole window all terms but the squares and the constant are at right angles.
    fn whole(&self, x: usize, y: usize) -> Quadric {
        let radius = self.radius as i64;
        let side = (2 * radius + 1) as f64;
        let power = |exponent: u32| (-radius..=radius).map(|k| k.pow(exponent) as f64).sum::<f64>();
        let (second, fourth) = (power(2), power(4));
        let middle = second / side;
        let mut sums = [0.0; 5];
        for (east, north, z) in self.window(x, y, self.radius) {
            let terms = [east, north, east * east - middle, east * north, north * north - middle];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term * z;
            }
        }
        let [p, q, a, s, b] = sums;
        let (slope, square) = (side * second, side * (fourth - second * middle));
        self.in_metres([p / slope, q / slope, a / square, s / (second * second), b / square])
    }

    /// The same of the heights of 3 × 3 cells: rows from the north, columns from the west.
    #[inline(always)]
    pub(super) fn of_heights(&self, heights: [[f64; 3]; 3]) -> Quadric {
        let [[nw, n, ne], [w, here, e], [sw, s, se]] = heights;
        let west_to_east = (ne - nw) + (e - w) + (se - sw);
        let south_to_north = (nw - sw) + (n - s) + (ne - se);
        let corners = (nw - here) + (ne - here) + (sw - here) + (se - here);
        let [across, down] = [(w - here) + (e - here), (n - here) + (s - here)];
        let cell = self.domain.cell;
        let (slope, second) = (1.0 / (6.0 * cell), 1.0 / (3.0 * cell * cell));
        Quadric {
            p: west_to_east * slope,
            q: south_to_north * slope,
            r: (corners + across - 2.0 * down) * second,
            s: ((ne - nw) - (se - sw)) * (0.75 * second),
            t: (corners + down - 2.0 * across) * second,
        }
    }

    fn partial(&self, x: usize, y: usize) -> Quadric {
        let radii = self.radius..=self.radius + WIDENING;
        let fits = radii.map(|radius| fit(self.window(x, y, radius)));
        let mut widest = None;
        for fit in fits {
            let whole = fit.determined == TERMS;
            widest = Some(fit);
            if whole {
                break;
            }
        }
        let [_, p, q, a, b, s] = widest.expect("there is a window of each radius").solution;
        self.in_metres([p, q, a, s, b])
    }

    /// From coefficients of `x, y, x², xy, y²` in metres of height and cells of length.
    fn in_metres(&self, [p, q, a, s, b]: [f64; 5]) -> Quadric {
        let cell = self.domain.cell;
        let area = cell * cell;
        Quadric { p: p / cell, q: q / cell, r: 2.0 * a / area, s: s / area, t: 2.0 * b / area }
    }
}

/// A fit, and how many of its terms the points determine.
struct Fit {
    solution: [f64; TERMS],
    determined: usize,
}

/// Least squares with the terms `1, x, y, x², y², xy` by their normal equations; a term that the ones before it
/// and the points leave undetermined is 0.
fn fit(points: impl Iterator<Item = (f64, f64, f64)>) -> Fit {
    let mut matrix = [[0.0; TERMS + 1]; TERMS];
    for (x, y, z) in points {
        let terms = [1.0, x, y, x * x, y * y, x * y];
        for (row, own) in matrix.iter_mut().zip(terms) {
            for (sum, other) in row.iter_mut().zip(terms.iter().chain(&[z])) {
                *sum += own * other;
            }
        }
    }
    eliminated(matrix)
}

/// Gauss–Jordan elimination without exchanges, which the order of the terms needs and a Gram matrix allows.
fn eliminated(mut matrix: [[f64; TERMS + 1]; TERMS]) -> Fit {
    let scale: [f64; TERMS] = std::array::from_fn(|term| matrix[term][term]);
    let mut kept = [false; TERMS];
    for term in 0..TERMS {
        let pivot = matrix[term][term];
        kept[term] = pivot > UNDETERMINED * scale[term].max(1.0);
        if !kept[term] {
            continue;
        }
        let line = matrix[term].map(|value| value / pivot);
        for (at, row) in matrix.iter_mut().enumerate() {
            let factor = if at == term { 0.0 } else { row[term] };
            for (value, own) in row.iter_mut().zip(line) {
                *value -= factor * own;
            }
        }
        matrix[term] = line;
    }
    let solution = std::array::from_fn(|term| if kept[term] { matrix[term][TERMS] } else { 0.0 });
    Fit { solution, determined: kept.iter().filter(|&&kept| kept).count() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Mask, Size};

    const CELL: f64 = 10.0;
    const TRUE: Quadric = Quadric { p: 0.25, q: -0.5, r: 0.0125, s: 0.003_125, t: -0.025 };

    /// A quadratic surface around column 4, row 3 of 9 × 7 cells, whose heights `f32` holds exactly.
    fn domain(valid: impl Fn(usize, usize) -> bool) -> (Domain, Field) {
        let size = Size::new(9, 7).expect("small");
        let flags = (0..size.cells()).map(|cell| valid(cell % 9, cell / 9)).collect();
        let height = Field::from_function(size, |x, y| {
            let (x, y) = ((x as f64 - 4.0) * CELL, (3.0 - y as f64) * CELL);
            let Quadric { p, q, r, s, t } = TRUE;
            (0.5 * r * x * x + s * x * y + 0.5 * t * y * y + p * x + q * y + 500.0) as f32
        });
        (Domain { valid: Mask::new(size, flags), ..Domain::new(size, CELL) }, height)
    }

    fn assert_close(found: Quadric, expected: Quadric, place: &str) {
        let pairs = [
            (found.p, expected.p, 1e-9),
            (found.q, expected.q, 1e-9),
            (found.r, expected.r, 1e-10),
            (found.s, expected.s, 1e-10),
            (found.t, expected.t, 1e-10),
        ];
        let close = pairs.iter().all(|(a, b, tolerance)| (a - b).abs() < *tolerance);
        assert!(close, "{place}: {found:?} instead of {expected:?}");
    }

    /// The true surface seen from another cell.
    fn seen_from(x: usize, y: usize) -> Quadric {
        let (x, y) = ((x as f64 - 4.0) * CELL, (3.0 - y as f64) * CELL);
        Quadric { p: TRUE.p + TRUE.r * x + TRUE.s * y, q: TRUE.q + TRUE.s * x + TRUE.t * y, ..TRUE }
    }

    #[test]
    fn a_quadratic_surface_is_found_exactly_in_every_cell_also_at_the_edge() {
        let (domain, height) = domain(|_, _| true);
        for (cell, radius) in (0..63).flat_map(|cell| [(cell, CELL), (cell, 2.0 * CELL), (cell, 2.6 * CELL)])
        {
            let found = Surface::new(&height, &domain).reaching(radius).expect("narrow");
            let found = found.at(cell % 9, cell / 9);
            assert_close(found, seen_from(cell % 9, cell / 9), &format!("cell {cell}, radius {radius} m"));
        }
    }

    #[test]
    fn cells_without_data_do_not_bend_the_surface_around_them() {
        let (domain, mut height) = domain(|x, y| (x * 3 + y * 5) % 7 != 0);
        let valid = domain.valid.clone().expect("some cells have no data");
        for (cell, value) in height.values_mut().iter_mut().enumerate() {
            if !valid.is_valid_at(cell) {
                *value = -1.0e6;
            }
        }
        for cell in (0..63).filter(|&cell| valid.is_valid_at(cell)) {
            let found = Surface::new(&height, &domain).at(cell % 9, cell / 9);
            assert_close(found, seen_from(cell % 9, cell / 9), &format!("cell {cell}"));
        }
    }

    #[test]
    fn a_window_wider_than_the_limit_is_refused_with_what_is_legal() {
        let (domain, height) = domain(|_, _| true);
        let error = Surface::new(&height, &domain).reaching(330.0).err().expect("33 cells").to_string();
        assert!(error.contains("33 cells") && error.contains("at most 320 m"), "{error}");
    }

    #[test]
    fn cells_on_a_line_tell_the_slope_along_it_and_a_lonely_cell_is_level() {
        let (domain, height) = domain(|x, y| y == 3 || (x, y) == (4, 0));
        let along = Surface::new(&height, &domain).at(8, 3);
        assert!((along.p - seen_from(8, 3).p).abs() < 1e-9 && along.q == 0.0, "{along:?}");
        let (domain, height) = self::domain(|x, y| (x, y) == (4, 0));
        assert_eq!(Surface::new(&height, &domain).at(4, 0), Quadric::default());
    }
}
