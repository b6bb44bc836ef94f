//! Fault formation: random lines cut the ground; one side of each goes up, the other down, by steps that
//! shrink.
//!
//! For fault `i` of `n`, with the line through `p0` and `p1`, a point `P` moves by
//!
//! ```text
//! s_i = scale (1 - i/n)     up where (p1 - p0)_x (P - p0)_y - (p1 - p0)_y (P - p0)_x > 0, else down
//! ```
//!
//! so points on the line go down and the last fault has size 0. The method is common in games (see the OGLDEV
//! tutorial "Fault Formation Terrain"). Lines come from [`Minstd`]: each fault seeds its own generator with
//! the next number of the run's and takes `p0.x`, `p0.y`, `p1.x`, `p1.y` modulo the size, again if the points
//! are equal.
//!
//! What differs: in one row each fault is a single step, so a row costs one addition a fault and one prefix
//! sum instead of a comparison for every fault and cell. Steps are counted in units of `scale / n`, which are
//! whole numbers, so the sum is exact and its order does not matter.

mod program;

use rayon::prelude::*;

use super::minstd::Minstd;
use super::relief;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::vectors;
use weald_engine::generator::Generator;
use weald_engine::on_device::OnDevice;
use weald_engine::step::{Entry, Stage};

/// Sides of the largest grid on which the side of a line is a number of 32 bits.
const MAX_SIDE: usize = 1 << 15;

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Fault>(
    "fault",
    Stage::Generate,
    "random lines lift one side and lower the other, by heights that shrink",
    "Fault formation, common in games (OGLDEV tutorial)",
);

parameters! {
    /// Fault formation.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::fault::Fault;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(48, 32)?, 10.0)); // columns, rows, metres
    /// Fault { relief: Some(100.0), ..Fault::default() }.run(&mut landscape, &Job::unwatched(7))?; // 7 is the seed
    /// let (lowest, highest) = landscape.field("height")?.range(None).expect("there are cells");
    /// assert!((highest - lowest - 100.0).abs() < 0.001, "from {lowest} to {highest} m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Fault {
        /// Number of faults. The last one has size 0, so 1 gives a flat map.
        // At 65,536 the largest possible sum of steps still fits in 32 bits.
        iterations: u32 = 200, range 1..=65_536;
        /// Height by which the first fault would move its sides if there were endlessly many; later ones
        /// shrink evenly to 0.
        scale: f64 = 10.0, range 0.0..=1.0e6, unit "m";
        /// Height between the lowest and the highest point. Without it heights lie on both sides of 0, at
        /// most `scale * (iterations - 1) / 2` from it.
        relief: Option<f64> = None, range 0.0..=1.0e6, unit "m";
        /// A seed of its own. Without it the landscape's is used, varied for each step.
        seed: Option<u64> = None, range 0..=9_007_199_254_740_991_i64;
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Fault {
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error> {
        let columns = domain.size.columns;
        let edges = Edges::of(&lines(domain.size, self.iterations, seed), columns);
        let mut field = Field::filled(domain.size, 0.0);
        let unit = self.scale / f64::from(self.iterations);
        field.values_mut().par_chunks_mut(columns * ROWS_PER_TASK).enumerate().for_each(|(task, band)| {
            vectors::widest(
                #[inline(always)]
                || fill_band(&edges, task * ROWS_PER_TASK, band, unit),
            );
        });
        Ok(self.brought_to_relief(field))
    }

    fn on_device(&self, domain: &Domain, seed: u64) -> Option<OnDevice> {
        let Size { columns, rows } = domain.size;
        let fits = columns.max(rows) <= MAX_SIDE && domain.size.cells() > 1;
        fits.then(|| self.sum_of_steps(&lines(domain.size, self.iterations, seed), domain.size))
    }

    fn finish(&self, domain: &Domain, made: Vec<f32>) -> Field {
        let unit = self.scale / f64::from(self.iterations);
        let heights = made.into_iter().map(|steps| metres(steps.to_bits() as i32, unit)).collect();
        self.brought_to_relief(Field::from_values(domain.size, heights))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }

    fn own_seed(&self) -> Option<u64> {
        self.seed
    }

    fn iterations(&self) -> u64 {
        u64::from(self.iterations)
    }
}

impl Fault {
    /// The method as published: every fault looks at every cell. For tests and the bench; the same bits as
    /// [`Generator::fill`].
    pub fn naive(&self, size: Size, seed: u64) -> Field {
        let lines = lines(size, self.iterations, seed);
        let unit = self.scale / f64::from(self.iterations);
        let mut field = Field::filled(size, 0.0);
        let mut steps = vec![0; size.columns];
        for y in 0..size.rows {
            steps.fill(0);
            for line in &lines {
                vectors::widest(
                    #[inline(always)]
                    || line.move_row(y as i64, &mut steps),
                );
            }
            for (value, &steps) in field.row_mut(y).iter_mut().zip(&steps) {
                *value = metres(steps, unit);
            }
        }
        self.brought_to_relief(field)
    }

    fn brought_to_relief(&self, mut field: Field) -> Field {
        if let Some(relief) = self.relief {
            relief::rescale(&mut field, relief as f32);
        }
        field
    }
}

/// Rows that one task fills: enough to pay for its scratch memory.
const ROWS_PER_TASK: usize = 16;

/// A fault: a line through two cells and the height of its step in units of `scale / n`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Line {
    start: [i64; 2],
    along: [i64; 2],
    steps: i32,
}

impl Line {
    /// Above 0 on the side that goes up.
    #[inline(always)]
    fn side(&self, x: i64, y: i64) -> i64 {
        self.along[0] * (y - self.start[1]) - self.along[1] * (x - self.start[0])
    }

    /// Adds this fault to every cell of a row.
    #[inline(always)]
    fn move_row(&self, y: i64, row: &mut [i32]) {
        for (x, steps) in (0..).zip(row) {
            *steps += if self.side(x, y) > 0 { self.steps } else { -self.steps };
        }
    }
}

/// The faults of a run. A grid of one cell has no line.
fn lines(size: Size, count: u32, seed: u64) -> Vec<Line> {
    if size.cells() == 1 {
        return Vec::new();
    }
    let mut seeds = Minstd::new(seed);
    let line = |index: u32| {
        let [start, end] = two_cells(size, seeds.draw());
        let along = [end[0] - start[0], end[1] - start[1]];
        Line { start, along, steps: (count - index) as i32 }
    };
    (1..=count).map(line).collect()
}

fn two_cells(size: Size, seed: u64) -> [[i64; 2]; 2] {
    let mut generator = Minstd::new(seed);
    let mut cell = || {
        let x = generator.draw() % size.columns as u64;
        [x as i64, (generator.draw() % size.rows as u64) as i64]
    };
    loop {
        let [start, end] = [cell(), cell()];
        if start != end {
            return [start, end];
        }
    }
}

#[inline(always)]
fn metres(steps: i32, unit: f64) -> f32 {
    (f64::from(steps) * unit) as f32
}

#[inline(always)]
fn fill_band(edges: &Edges, first: usize, band: &mut [f32], unit: f64) {
    let columns = edges.columns as usize;
    let mut crossings = vec![0; edges.jump.len()];
    let mut jumps = vec![0; columns + 1];
    for (y, row) in (first..).zip(band.chunks_exact_mut(columns)) {
        edges.cross(y, &mut crossings);
        jumps.fill(0);
        jumps[0] = edges.west;
        for (&at, &jump) in crossings.iter().zip(&edges.jump) {
            jumps[at as usize] += jump;
        }
        let mut steps = 0_i32;
        for jump in &mut jumps {
            steps = steps.wrapping_add(*jump);
            *jump = steps;
        }
        for (value, &steps) in row.iter_mut().zip(&jumps) {
            *value = metres(steps, unit);
        }
    }
}

/// Where each fault crosses a row, and the jump of the ground there.
///
/// Sides of a line are whole numbers, so "above 0" is the same as "above one half", and no cell lies on the
/// line moved by that half. Along row `y` it is crossed at `slope * y + offset`; rounding up gives the first
/// cell beyond. The moved crossing stays `0.5 / |dy|` away from every cell, and on the largest grid (sides of
/// 2^20) the rounding errors are below `2^-11 / |dy|`, so the cell is exact.
struct Edges {
    slope: Vec<f64>,
    offset: Vec<f64>,
    jump: Vec<i32>,
    /// Steps at the western end of every row, if all lines were crossed east of it.
    west: i32,
    columns: f64,
}

impl Edges {
    fn of(lines: &[Line], columns: usize) -> Self {
        // Along a row from west to east, a line that goes south is crossed from its upper to its lower side.
        let falls = |line: &Line| line.along[1] > 0;
        let inverse = |line: &Line| inverse_run(line.along[1]);
        let slope = lines.iter().map(|line| line.along[0] as f64 * inverse(line)).collect();
        let offset = lines.iter().map(|line| {
            let moved = -0.5 - (line.along[0] * line.start[1]) as f64;
            line.start[0] as f64 + moved * inverse(line)
        });
        let jump = lines.iter().map(|line| if falls(line) { -2 * line.steps } else { 2 * line.steps });
        let west = lines.iter().map(|line| if falls(line) { line.steps } else { -line.steps });
        Self {
            slope,
            offset: offset.collect(),
            jump: jump.collect(),
            west: west.sum(),
            columns: columns as f64,
        }
    }

    /// The first column beyond each fault in row `y`, from 0 to the number of columns.
    #[inline(always)]
    fn cross(&self, y: usize, crossings: &mut [i32]) {
        let y = y as f64;
        for ((at, slope), offset) in crossings.iter_mut().zip(&self.slope).zip(&self.offset) {
            *at = (slope * y + offset).ceil().max(0.0).min(self.columns) as i32;
        }
    }
}

/// `1 / dy`. A line along a row is crossed beyond one end of it or the other: as a steep one would be.
fn inverse_run(dy: i64) -> f64 {
    if dy == 0 { -f64::from(1 << 30) } else { 1.0 / dy as f64 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn fault(iterations: u32) -> Fault {
        Fault { iterations, scale: f64::from(iterations), ..Fault::default() }
    }

    fn filled(fault: &Fault, size: Size, seed: u64) -> Field {
        fault.fill(&Domain::new(size, 1.0), seed).expect("any grid will do")
    }

    #[test]
    fn a_point_on_a_line_goes_down_whichever_way_the_line_runs() {
        for along in [[2, 2], [-2, -2], [3, 0], [-3, 0], [0, 2], [0, -2], [2, -1], [-1, 2]] {
            let line = Line { start: [2, 2], along, steps: 1 };
            let mut heights = vec![0.0; 25];
            fill_band(&Edges::of(&[line], 5), 0, &mut heights, 1.0);
            assert_eq!(heights[2 * 5 + 2], -1.0, "the point that the line starts from");
            for (place, height) in (0..).zip(heights) {
                let up = line.side(place % 5, place / 5) > 0;
                assert_eq!(height, if up { 1.0 } else { -1.0 }, "{along:?} at {place}");
            }
        }
    }

    #[test]
    fn one_fault_is_flat_since_the_last_has_no_height() {
        let field = filled(&fault(1), Size::new(9, 7).expect("small"), 3);
        assert!(field.values().iter().all(|&height| height == 0.0));
    }

    #[test]
    fn a_crossing_is_exact_on_the_largest_sides() {
        let side = 1 << 20;
        let lines = lines(Size { columns: side, rows: side }, 400, 11);
        let edges = Edges::of(&lines, side);
        let mut crossings = vec![0; lines.len()];
        for y in [0, 1, 524_287, 777_777, side - 1] {
            edges.cross(y, &mut crossings);
            for (line, &at) in lines.iter().zip(&crossings) {
                let up = |x: i64| line.side(x, y as i64) > 0;
                let west_is_up = line.along[1] > 0;
                assert!(at == 0 || up(i64::from(at) - 1) == west_is_up, "{line:?} in row {y}");
                assert!(at == side as i32 || up(i64::from(at)) != west_is_up, "{line:?} in row {y}");
            }
        }
    }

    proptest! {
        #[test]
        fn difference_rows_give_the_bits_of_the_naive_sum(
            (columns, rows) in (1_usize..50, 1_usize..50), iterations in 1_u32..60, seed: u64,
        ) {
            let size = Size::new(columns, rows).expect("small");
            let fault = Fault { iterations, scale: 12.3, ..Fault::default() };
            prop_assert_eq!(filled(&fault, size, seed), fault.naive(size, seed));
        }

        #[test]
        fn heights_stay_within_the_sum_of_all_steps(side in 2_usize..40, iterations in 1_u32..200, seed: u64) {
            let field = filled(&fault(iterations), Size::square(side).expect("small"), seed);
            let bound = f64::from(iterations) * f64::from(iterations - 1) / 2.0;
            prop_assert!(field.values().iter().all(|&height| f64::from(height).abs() <= bound));
        }

        #[test]
        fn plateaus_are_no_more_than_lines_can_cut(side in 2_usize..60, iterations in 1_u32..12, seed: u64) {
            let field = filled(&fault(iterations), Size::square(side).expect("small"), seed);
            let mut heights: Vec<u32> = field.values().iter().map(|height| height.to_bits()).collect();
            heights.sort_unstable();
            heights.dedup();
            let n = iterations as usize;
            prop_assert!(heights.len() <= 1 + n + n * (n - 1) / 2);
        }

        #[test]
        fn one_more_fault_changes_differences_by_nothing_or_two_steps(
            size in (2_usize..30, 2_usize..30), seed: u64, last in 0_usize..20,
        ) {
            let size = Size::new(size.0, size.1).expect("small");
            let all = lines(size, 21, seed);
            let sum = |count: usize, x: usize, y: usize| -> i32 {
                let up = |line: &Line| if line.side(x as i64, y as i64) > 0 { line.steps } else { -line.steps };
                all[..count].iter().map(up).sum()
            };
            let moved = |x, y| sum(last + 1, x, y) - sum(last, x, y);
            let change = (moved(0, 0) - moved(size.columns - 1, size.rows - 1)).abs();
            prop_assert!(change == 0 || change == 2 * all[last].steps);
        }
    }
}
