//! Heights at the vertices of an engine's terrain, from the cells of a landscape.
//!
//! The first vertex lies on the centre of the north-western cell and the last on that of the south-eastern one,
//! so no vertex lies beyond the data, and tiles cut from one grid of vertices share their edges to the bit.
//! As many vertices as cells are the cells. More: Catmull-Rom interpolation (Catmull and Rom 1974), which
//! passes through the cells with continuous slopes, kept between the lowest and the highest of them. Fewer: the
//! mean under a tent as wide as two steps, since single cells would pass on whatever lies between two steps as
//! noise. Beyond an edge the ground goes on as it came, so a slope stays a slope there.
//!
//! A vertex has data where the cell nearest to it has; next to no-data, the mean of the nearest cells with data.

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

/// A layer at vertices.
#[derive(Clone, Debug)]
pub(super) struct Vertices {
    /// Values; 0 where there is no data.
    pub(super) field: Field,
    /// Vertices with data.
    pub(super) valid: Option<Mask>,
}

impl Vertices {
    /// Brings a layer to vertices.
    ///
    /// # Errors
    /// [`Error::Limit`] where there are too many, [`Error::Run`] for a landscape that is one cell wide.
    pub(super) fn of(domain: &Domain, field: &Field, size: Size) -> Result<Self, Error> {
        ensure_extent(domain.size)?;
        let across = Axis::new(domain.size.columns, size.columns);
        let down = Axis::new(domain.size.rows, size.rows);
        let valid = domain.valid.as_ref().and_then(|valid| {
            let cells = down.nearest.iter().flat_map(|&y| across.nearest.iter().map(move |&x| (x, y)));
            Mask::new(size, cells.map(|(x, y)| valid.is_valid(x, y)).collect())
        });
        let cells = Cells { field, valid: domain.valid.as_ref() };
        let mut values = vec![0.0; size.cells()];
        values.par_chunks_mut(size.columns).enumerate().for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                if valid.as_ref().is_none_or(|valid| valid.is_valid(x, y)) {
                    *value = cells
                        .smooth(&across.smooth[x], &down.smooth[y])
                        .unwrap_or_else(|| cells.mean(&across.near[x], &down.near[y]));
                }
            }
        });
        Ok(Self { field: Field::from_values(size, values), valid })
    }

    /// Least and greatest value; both 0 without data.
    pub(super) fn range(&self) -> (f64, f64) {
        let (low, high) = self.field.range(self.valid.as_ref()).unwrap_or_default();
        (f64::from(low), f64::from(high))
    }

    /// The value at a vertex; the lowest one where there is no data.
    pub(super) fn value(&self, index: usize, low: f64) -> f64 {
        match &self.valid {
            Some(valid) if !valid.is_valid_at(index) => low,
            _ => f64::from(self.field.values()[index]),
        }
    }
}

/// Refuses a landscape that is one cell wide or deep.
pub(super) fn ensure_extent(size: Size) -> Result<(), Error> {
    if size.columns >= 2 && size.rows >= 2 {
        return Ok(());
    }
    Err(Error::Run(format!("a landscape of {size} cells has no extent; terrain for engines needs 2 a side")))
}

/// Cells along an axis with their weights.
#[derive(Clone, Debug)]
struct Taps {
    first: usize,
    weights: Vec<f64>,
}

impl Taps {
    fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        self.weights.iter().enumerate().map(|(at, weight)| (self.first + at, *weight))
    }

    /// Taps from weights of cells, of which some may lie before the first of `count` cells or behind the last:
    /// there the line through the edge cell and the cell as far inside goes on.
    fn carried_on(first: i64, weights: &[f64], count: usize) -> Self {
        let last = count as i64 - 1;
        let low = first.max(0);
        let high = (first + weights.len() as i64 - 1).min(last);
        let reach = (low - first).max(first + weights.len() as i64 - 1 - high);
        let (low, high) = ((low - reach).max(0), (high + reach).min(last));
        let mut taps = Self { first: low as usize, weights: vec![0.0; (high - low + 1) as usize] };
        for (at, weight) in (first..).zip(weights) {
            let edge = at.clamp(0, last);
            let mirrored = (2 * edge - at).clamp(0, last);
            if at == edge {
                taps.weights[(at - low) as usize] += weight;
            } else {
                taps.weights[(edge - low) as usize] += 2.0 * weight;
                taps.weights[(mirrored - low) as usize] -= weight;
            }
        }
        taps
    }

    /// Taps of the cells that exist alone.
    fn cut_off(first: i64, weights: &[f64], count: usize) -> Self {
        let low = first.clamp(0, count as i64 - 1);
        let kept = (first..).zip(weights).filter(|(at, _)| (0..count as i64).contains(at));
        Self { first: low as usize, weights: kept.map(|(_, weight)| *weight).collect() }
    }
}

/// How the vertices along an axis come from its cells.
#[derive(Debug)]
struct Axis {
    /// Weights that pass slopes on, and may be below 0.
    smooth: Vec<Taps>,
    /// Weights above 0, for places next to no-data.
    near: Vec<Taps>,
    nearest: Vec<usize>,
}

impl Axis {
    fn new(cells: usize, vertices: usize) -> Self {
        let step = (cells - 1) as f64 / (vertices.max(2) - 1) as f64;
        let place = |vertex: usize| (vertex as f64 * step).min((cells - 1) as f64);
        let each = |taps: &dyn Fn(f64) -> Taps| (0..vertices).map(|vertex| taps(place(vertex))).collect();
        Self {
            smooth: each(&|place| {
                let (first, weights) = if step > 1.0 { tent(place, step) } else { catmull_rom(place) };
                Taps::carried_on(first, &weights, cells)
            }),
            near: each(&|place| {
                let (first, weights) = if step > 1.0 { tent(place, step) } else { linear(place) };
                Taps::cut_off(first, &weights, cells)
            }),
            nearest: (0..vertices).map(|vertex| place(vertex).round() as usize).collect(),
        }
    }
}

/// First cell and weights of the mean under a tent around a place, of ground that is linear between cells: a slope
/// keeps its heights wherever the tent stands, which a tent of the cells alone does not give it.
fn tent(place: f64, radius: f64) -> (i64, Vec<f64>) {
    let first = libm::floor(place - radius) as i64;
    let last = libm::ceil(place + radius) as i64;
    (first, (first..=last).map(|cell| under_tent(cell as f64 - place, radius)).collect())
}

/// Share in the mean of a cell that lies `distance` from the middle: a hat of one cell a side folded with the tent,
/// piece by piece a cubic.
fn under_tent(distance: f64, radius: f64) -> f64 {
    const SECOND_DIFFERENCE: [(f64, f64); 3] = [(-1.0, 1.0), (0.0, -2.0), (1.0, 1.0)];
    let mut sum = 0.0;
    for (cell, of_hat) in SECOND_DIFFERENCE {
        for (side, of_tent) in SECOND_DIFFERENCE {
            let beyond = (cell + side * radius - distance.abs()).max(0.0);
            sum += of_hat * of_tent * beyond * beyond * beyond;
        }
    }
    sum / (6.0 * radius * radius)
}

/// First of two cells around a place and their weights.
fn linear(place: f64) -> (i64, Vec<f64>) {
    let before = libm::floor(place);
    (before as i64, vec![1.0 - (place - before), place - before])
}

/// First of four cells around a place and their weights.
fn catmull_rom(place: f64) -> (i64, Vec<f64>) {
    let before = libm::floor(place);
    let t = place - before;
    let weights = vec![
        0.5 * t * (-1.0 + t * (2.0 - t)),
        1.0 + 0.5 * t * t * (-5.0 + 3.0 * t),
        0.5 * t * (1.0 + t * (4.0 - 3.0 * t)),
        0.5 * t * t * (t - 1.0),
    ];
    (before as i64 - 1, weights)
}

/// The cells of a layer.
struct Cells<'a> {
    field: &'a Field,
    valid: Option<&'a Mask>,
}

impl Cells<'_> {
    fn at(&self, x: usize, y: usize) -> Option<f64> {
        self.valid.is_none_or(|valid| valid.is_valid(x, y)).then(|| f64::from(self.field.at(x, y)))
    }

    /// The weighted sum, within the range of the cells; `None` where one of them has no data.
    fn smooth(&self, across: &Taps, down: &Taps) -> Option<f32> {
        let (mut sum, mut low, mut high) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for (y, weight_y) in down.iter().filter(|(_, weight)| *weight != 0.0) {
            for (x, weight_x) in across.iter().filter(|(_, weight)| *weight != 0.0) {
                let value = self.at(x, y)?;
                sum += weight_x * weight_y * value;
                (low, high) = (low.min(value), high.max(value));
            }
        }
        Some(sum.clamp(low, high) as f32)
    }

    /// The mean of the cells with data.
    fn mean(&self, across: &Taps, down: &Taps) -> f32 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (y, weight_y) in down.iter() {
            for (x, weight_x) in across.iter() {
                if let Some(value) = self.at(x, y) {
                    sum += weight_x * weight_y * value;
                    weights += weight_x * weight_y;
                }
            }
        }
        if weights > 0.0 { (sum / weights) as f32 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn domain(columns: usize, rows: usize) -> Domain {
        Domain::new(Size { columns, rows }, 10.0)
    }

    fn brought(domain: &Domain, field: &Field, columns: usize, rows: usize) -> Field {
        Vertices::of(domain, field, Size { columns, rows }).expect("extent").field
    }

    #[test]
    fn as_many_vertices_as_cells_are_the_cells() {
        let field =
            Field::from_function(Size { columns: 7, rows: 5 }, |x, y| (x * x * 31 + y * 7) as f32 / 3.0);
        assert_eq!(brought(&domain(7, 5), &field, 7, 5), field);
    }

    #[test]
    fn a_plane_stays_a_plane_up_to_its_edges_finer_and_coarser() {
        let plane = |x: f64, y: f64| (3.0 * x - 2.0 * y) as f32;
        let field = Field::from_function(Size { columns: 41, rows: 31 }, |x, y| plane(x as f64, y as f64));
        for (columns, rows) in [(127, 253), (13, 9), (82, 7), (5, 100), (2, 2)] {
            let vertices = brought(&domain(41, 31), &field, columns, rows);
            for y in 0..rows {
                for x in 0..columns {
                    let place = |at: usize, cells: f64, count: usize| at as f64 * cells / (count - 1) as f64;
                    let expected = plane(place(x, 40.0, columns), place(y, 30.0, rows));
                    let value = vertices.at(x, y);
                    assert!(
                        (value - expected).abs() < 2e-4,
                        "{columns} × {rows}: {value} for {expected} at {x}, {y}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_single_peak_is_neither_lost_nor_exceeded() {
        let field = Field::from_function(Size { columns: 64, rows: 64 }, |x, y| {
            f32::from(u8::from((x, y) == (33, 20)))
        });
        let finer = brought(&domain(64, 64), &field, 127, 127);
        assert_eq!(finer.range(None), Some((0.0, 1.0)));
        assert_eq!(finer.at(66, 40), 1.0);
        let coarser = brought(&domain(64, 64), &field, 17, 17);
        let (low, high) = coarser.range(None).expect("cells");
        assert!(low == 0.0 && high > 0.01 && high < 0.1, "{low} to {high}");
    }

    #[test]
    fn cells_without_data_never_take_part() {
        let size = Size { columns: 20, rows: 20 };
        let valid = Mask::new(size, (0..400).map(|index| index % 20 < 12).collect());
        let field = Field::from_function(size, |x, _| if x < 12 { 5.0 } else { f32::NAN });
        let domain = Domain { valid, ..domain(20, 20) };
        for side in [9, 33, 127] {
            let vertices = Vertices::of(&domain, &field, Size { columns: side, rows: side }).expect("extent");
            assert_eq!(vertices.range(), (5.0, 5.0), "{side}");
            let valid = vertices.valid.expect("some have none");
            assert!(valid.is_valid(0, 3) && !valid.is_valid(side - 1, 3));
        }
    }

    #[test]
    fn a_landscape_one_cell_wide_is_refused() {
        let field = Field::filled(Size { columns: 1, rows: 9 }, 1.0);
        let error =
            Vertices::of(&domain(1, 9), &field, Size { columns: 127, rows: 127 }).expect_err("a line");
        assert!(error.to_string().contains("1 × 9 cells has no extent"), "{error}");
    }
}
