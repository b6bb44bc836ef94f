//! How high the horizon stands around each cell: the ground that hides sun and sky.
//!
//! For one azimuth the grid is crossed by parallel lines, one a cell of the shorter way, each walked away from
//! the light. A line keeps the upper convex hull of the ground behind it; the tangent from a point to that hull
//! is its horizon, and what the tangent passes over can be forgotten:
//!
//! ```text
//! while slope(point, top) ≤ slope(point, below top): pop          horizon = slope(point, top)
//! ```
//!
//! so that every point enters and leaves the hull once, whatever the extent of the ground. Timonen and Westerholm
//! 2010, "Scalable Height Field Self-Shadowing", doi 10.1111/j.1467-8659.2009.01642.x; horizons as a description
//! of ground: Max 1988, "Horizon mapping", doi 10.1007/BF01905562. Differs: heights between two cells and
//! horizons between two lines are interpolated, so that a plane has the horizon of a plane in every direction.
//! A line takes no heights where one of the two cells has no data; a cell that no line can see from, and ground
//! with nothing behind it, has an open horizon. The Earth is flat.

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_engine::Job;

/// Horizon where no ground lies in that direction.
pub(super) const OPEN: f32 = f32::NEG_INFINITY;

/// Rows and columns in a block when rows become columns.
const BLOCK: usize = 32;

/// Ground ready for horizons in any direction.
pub(super) struct Ground {
    cell: f64,
    /// Lines of this run from west to east, or back.
    rows: Slab,
    /// Lines of this run from north to south, or back.
    columns: Slab,
}

/// Heights with the axis along which lines run in memory; not a number where there are none.
struct Slab {
    length: usize,
    heights: Vec<f32>,
}

impl Slab {
    fn breadth(&self) -> usize {
        self.heights.len() / self.length
    }

    fn height(&self, along: usize, across: isize) -> f32 {
        match usize::try_from(across) {
            Ok(across) if across < self.breadth() => self.heights[across * self.length + along],
            _ => f32::NAN,
        }
    }
}

impl Ground {
    pub(super) fn new(height: &Field, domain: &Domain) -> Self {
        let size = domain.size;
        let value = |(cell, &height): (usize, &f32)| {
            let has_data = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
            if has_data { height } else { f32::NAN }
        };
        let heights: Vec<f32> = height.values().par_iter().enumerate().map(value).collect();
        let columns = Slab { length: size.rows, heights: transposed(&heights, size.columns) };
        Self { cell: domain.cell, rows: Slab { length: size.columns, heights }, columns }
    }

    /// Tangents of the elevation of the horizon at that azimuth, in radians clockwise from north; [`OPEN`] where
    /// no ground lies there.
    pub(super) fn horizon(&self, azimuth: f64) -> Vec<f32> {
        let (east, south) = (libm::sin(azimuth), -libm::cos(azimuth));
        if east.abs() >= south.abs() {
            Sweep::new(&self.rows, self.cell, east, south).horizon()
        } else {
            let found = Sweep::new(&self.columns, self.cell, south, east).horizon();
            transposed(&found, self.columns.length)
        }
    }

    /// Calls `visit` with each of so many even azimuths from north, its horizon and that of the next one.
    ///
    /// # Errors
    /// [`Error::Interrupted`] where the user ends the run.
    pub(super) fn around(
        &self,
        directions: usize,
        job: &Job<'_>,
        mut visit: impl FnMut(Direction<'_>),
    ) -> Result<(), Error> {
        let azimuth = |at: usize| std::f64::consts::TAU * at as f64 / directions as f64;
        let first = self.horizon(0.0);
        let mut here = first.clone();
        for at in 0..directions {
            let next = if at + 1 < directions { self.horizon(azimuth(at + 1)) } else { first.clone() };
            visit(Direction { number: at, azimuth: azimuth(at), horizon: &here, next: &next });
            here = next;
            job.watcher.progress(at as u64 + 1, directions as u64, self.rows.heights.len());
            if job.watcher.cancelled() {
                return Err(Error::Interrupted(String::new()));
            }
        }
        Ok(())
    }
}

/// One of the directions around.
#[derive(Clone, Copy)]
pub(super) struct Direction<'a> {
    /// Counted from north over east.
    pub(super) number: usize,
    /// In radians clockwise from north.
    pub(super) azimuth: f64,
    /// Tangents of the horizon, cell by cell.
    pub(super) horizon: &'a [f32],
    /// The same in the next direction.
    pub(super) next: &'a [f32],
}

/// Lines across a slab at one azimuth.
struct Sweep<'a> {
    slab: &'a Slab,
    /// Whether lines begin at the far end of the axis.
    from_the_end: bool,
    /// Cells across for each cell along the way, -1 to 1.
    drift: f64,
    /// Metres from one point of a line to the next.
    stride: f64,
}

impl<'a> Sweep<'a> {
    /// From the direction of the light, of which `along` is the greater part.
    fn new(slab: &'a Slab, cell: f64, along: f64, across: f64) -> Self {
        let drift = -across / along.abs();
        // A direction along an axis or a diagonal misses it by rounding alone.
        let near = libm::round(drift);
        let drift = if (drift - near).abs() < 1e-12 { near } else { drift };
        let stride = cell * libm::sqrt(1.0 + drift * drift);
        Self { slab, from_the_end: along > 0.0, drift, stride }
    }

    fn horizon(&self) -> Vec<f32> {
        let lines = self.lines();
        let length = self.slab.length;
        let mut found = vec![OPEN; self.slab.heights.len()];
        found.par_chunks_mut(length).enumerate().for_each(|(across, row)| {
            for step in 0..length {
                row[self.along(step)] = self.between_lines(&lines, across, step);
            }
        });
        found
    }

    fn along(&self, step: usize) -> usize {
        if self.from_the_end { self.slab.length - 1 - step } else { step }
    }

    /// Whole cells that lines have drifted by a step, and the share of the next.
    fn drifted(&self, step: usize) -> (isize, f64) {
        let drifted = self.drift * step as f64;
        let whole = libm::floor(drifted);
        (whole as isize, drifted - whole)
    }

    /// Cells that a line drifts on its whole way.
    fn widest(&self) -> usize {
        libm::ceil(self.drift.abs() * (self.slab.length - 1) as f64) as usize
    }

    /// Place across of the first line's beginning.
    fn first(&self) -> isize {
        if self.drift > 0.0 { -(self.widest() as isize) - 1 } else { -1 }
    }

    /// The horizons of all lines, step by step.
    fn lines(&self) -> Vec<f32> {
        let count = self.slab.breadth() + self.widest() + 2;
        let mut lines = vec![OPEN; count * self.slab.length];
        lines.par_chunks_mut(self.slab.length).enumerate().for_each_init(Vec::new, |hull, (number, line)| {
            hull.clear();
            for (step, horizon) in line.iter_mut().enumerate() {
                if let Some(height) = self.height(self.first() + number as isize, step) {
                    *horizon = tangent(hull, (self.stride * step as f64, height));
                }
            }
        });
        lines
    }

    /// Height of a line at a step, between two cells.
    fn height(&self, line: isize, step: usize) -> Option<f64> {
        let ((whole, share), along) = (self.drifted(step), self.along(step));
        let near = f64::from(self.slab.height(along, line + whole));
        if share == 0.0 {
            return Some(near).filter(|height| !height.is_nan());
        }
        let far = f64::from(self.slab.height(along, line + whole + 1));
        Some(near * (1.0 - share) + far * share).filter(|height| !height.is_nan())
    }

    /// The horizon of a cell, between the two lines that pass it.
    fn between_lines(&self, lines: &[f32], across: usize, step: usize) -> f32 {
        let (whole, share) = self.drifted(step);
        let above = (across as isize - whole - self.first()) as usize;
        let of_line = |line: usize| lines[line * self.slab.length + step];
        let above_horizon = of_line(above);
        if share == 0.0 {
            return above_horizon;
        }
        let below_horizon = of_line(above - 1);
        if below_horizon == OPEN {
            above_horizon
        } else if above_horizon == OPEN {
            below_horizon
        } else {
            let share = share as f32;
            above_horizon * (1.0 - share) + below_horizon * share
        }
    }
}

/// Tangent from a point (way, height) to the hull of the points before it, which it then joins.
fn tangent(hull: &mut Vec<(f64, f64)>, point: (f64, f64)) -> f32 {
    let slope = |other: &(f64, f64)| (other.1 - point.1) / (point.0 - other.0);
    while let [.., below, top] = hull.as_slice() {
        if slope(top) > slope(below) {
            break;
        }
        hull.pop();
    }
    let horizon = hull.last().map_or(OPEN, |top| slope(top) as f32);
    hull.push(point);
    horizon
}

/// Columns in place of rows; `length` is that of a row.
fn transposed(values: &[f32], length: usize) -> Vec<f32> {
    let breadth = values.len() / length;
    let mut turned = vec![0.0; values.len()];
    turned.par_chunks_mut(breadth * BLOCK).enumerate().for_each(|(block, rows)| {
        let first = block * BLOCK;
        for start in (0..breadth).step_by(BLOCK) {
            for y in start..(start + BLOCK).min(breadth) {
                for (x, row) in rows.chunks_exact_mut(breadth).enumerate() {
                    row[y] = values[y * length + first + x];
                }
            }
        }
    });
    turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Mask, Size};

    fn ground(size: Size, cell: f64, height: impl Fn(f64, f64) -> f64) -> (Field, Domain) {
        let field = Field::from_function(size, |x, y| height(x as f64 * cell, y as f64 * cell) as f32);
        (field, Domain::new(size, cell))
    }

    #[test]
    fn a_plane_rises_to_its_horizon_in_every_direction() {
        let size = Size::new(40, 30).expect("small");
        let (field, domain) = ground(size, 5.0, |east, south| 0.3 * east + 0.7 * south);
        let ground = Ground::new(&field, &domain);
        for degree in (0..360).step_by(5) {
            let azimuth = f64::from(degree).to_radians();
            let rise = 0.3 * libm::sin(azimuth) - 0.7 * libm::cos(azimuth);
            let horizon = ground.horizon(azimuth);
            let seen: Vec<f32> = horizon.into_iter().filter(|&tangent| tangent != OPEN).collect();
            assert!(seen.len() > 1000, "{degree}°: most cells have ground before them");
            let worst = seen.iter().map(|&tangent| (f64::from(tangent) - rise).abs()).fold(0.0, f64::max);
            assert!(worst < 2e-5, "{degree}°: {worst}");
        }
    }

    /// The horizon by looking at every cell along an axis.
    fn searched(field: &Field, x: usize, y: usize, (dx, dy): (isize, isize), cell: f64) -> f32 {
        let size = field.size();
        let far = |step: isize| {
            let column = usize::try_from(x as isize + dx * step).ok().filter(|&x| x < size.columns)?;
            let row = usize::try_from(y as isize + dy * step).ok().filter(|&y| y < size.rows)?;
            Some((step, field.at(column, row)))
        };
        let stride = cell * libm::hypot(dx as f64, dy as f64);
        let slope = |(step, there): (isize, f32)| {
            ((f64::from(there) - f64::from(field.at(x, y))) / (stride * step as f64)) as f32
        };
        (1..).map_while(far).map(slope).fold(OPEN, f32::max)
    }

    #[test]
    fn along_axes_and_diagonals_the_hull_finds_what_a_search_of_all_cells_finds() {
        let size = Size::new(37, 23).expect("small");
        let (field, domain) = ground(size, 2.0, |x, y| {
            20.0 * weald_core::random::signed2(5, (x / 2.0) as i64, (y / 2.0) as i64)
        });
        let ground = Ground::new(&field, &domain);
        let headings = [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1)];
        for (number, towards) in headings.into_iter().enumerate() {
            let horizon = ground.horizon(std::f64::consts::FRAC_PI_4 * number as f64);
            for (cell, &found) in horizon.iter().enumerate() {
                let expected = searched(&field, cell % 37, cell / 37, towards, 2.0);
                let same = found == expected || (found - expected).abs() < 1e-5;
                assert!(same, "cell {cell}, direction {towards:?}: {found} instead of {expected}");
            }
        }
    }

    #[test]
    fn ground_without_data_hides_nothing() {
        let size = Size::new(21, 21).expect("small");
        let valid: Vec<bool> = (0..size.cells()).map(|cell| cell % 21 != 10).collect();
        let (mut field, domain) = ground(size, 1.0, |_, _| 3.0);
        for y in 0..21 {
            field.set(10, y, 1.0e6);
        }
        let domain = Domain { valid: Mask::new(size, valid), ..domain };
        let ground = Ground::new(&field, &domain);
        for degree in (0..360).step_by(9) {
            let horizon = ground.horizon(f64::from(degree).to_radians());
            assert!(horizon.iter().all(|&tangent| tangent == OPEN || tangent.abs() < 1e-6), "{degree}°");
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let size = Size::new(50, 41).expect("small");
        let (field, domain) =
            ground(size, 3.0, |x, y| 30.0 * weald_core::random::signed2(1, x as i64 / 9, y as i64 / 9));
        let ground = Ground::new(&field, &domain);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("starts");
            pool.install(|| (0..16).map(|at| ground.horizon(0.39 * f64::from(at))).collect::<Vec<_>>())
        };
        assert_eq!(with(1), with(3));
    }
}
