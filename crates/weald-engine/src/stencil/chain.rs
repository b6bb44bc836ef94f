//! Steps of a simulation as streams of rows, chained.
//!
//! One step takes rows from north to south and gives each row back a few rows later, changed. Chaining the
//! streams of several steps advances the simulation by that many steps in one pass over memory
//! (temporal blocking by skewing). A stretch of rows is computed as a subdomain of its own with walls at
//! both ends; rows that lie further from an end than `reach` cells per step do not feel it, so that bands with
//! halos give the same bits as the whole, whatever the number of bands and of steps in a time block.

use std::ops::Range;

use pulp::{Arch, NullaryFnOnce};

use super::ring::Ring;
use super::segment::PlaneRow;
use crate::kernel;
use crate::program::Program;
use crate::sums::{Means, Part};
pub use crate::sums::{RowSums, SUMS};
use crate::uniform::{FromWords, Uniform};
use weald_core::grid::Size;

/// A simulation step as a stream of rows.
pub trait Process: Send + Sync + 'static {
    /// What differs from step to step: rain or sunshine.
    type Weather: Uniform + FromWords + Copy + Send + Sync + 'static;
    /// Rows in flight within one step.
    type Scratch: Send + Sync;

    /// Planes that steps change.
    fn state_planes(&self) -> usize;
    /// Planes that stay, stored behind the state planes.
    fn constant_planes(&self) -> usize;
    /// Rows by which a step's output lies behind its input.
    fn lag(&self) -> usize;
    /// Rows of its input and its constants, behind the newest one, that it looks back at.
    fn look_back(&self) -> usize {
        self.lag()
    }
    /// Rows by which it begins its output behind the newest one of its input.
    fn begins(&self) -> usize {
        self.lag()
    }
    /// Farthest row that a row of the output depends on.
    fn reach(&self) -> usize {
        self.lag() + 1
    }
    /// Memory for one step over rows of this many cells.
    fn scratch(&self, columns: usize) -> Self::Scratch;
    /// The same process over a part of the domain, as if it were the whole.
    #[must_use]
    fn sized(&self, size: Size) -> Self
    where
        Self: Sized;
    /// The same step as compute passes.
    fn program(&self) -> Program;
    /// Takes row `flow.y` in and finishes row `flow.y - lag` of the output.
    fn advance(&self, flow: &mut Flow<'_, Self>);
}

/// Everything one step sees when a row comes in.
pub struct Flow<'a, P: Process + ?Sized> {
    /// Planes that stay.
    pub constants: &'a [Ring],
    /// Rows as the step finds them.
    pub input: &'a [Ring],
    /// Rows as the step leaves them.
    pub output: &'a mut [Ring],
    /// Rows in flight.
    pub scratch: &'a mut P::Scratch,
    /// Rain or sunshine of this step.
    pub weather: P::Weather,
    /// The row that comes in; beyond `span.end` when the last rows flow out.
    pub y: usize,
    /// The rows of this subdomain, between its walls.
    pub span: Range<usize>,
    /// Sums of the rows that this band owns; the others are another band's.
    pub sums: &'a mut SumsOfRows<'a>,
}

impl<P: Process + ?Sized> Flow<'_, P> {
    /// The row `behind` rows behind the newest, where it exists.
    pub fn behind(&self, behind: usize) -> Option<usize> {
        self.y.checked_sub(behind).filter(|row| self.span.contains(row))
    }

    /// The row after `y`, or `y` itself before a wall.
    pub fn next(&self, y: usize) -> usize {
        if y + 1 < self.span.end { y + 1 } else { y }
    }
}

/// Row sums of the rows that a band owns.
pub struct SumsOfRows<'a> {
    /// First row owned.
    pub first: usize,
    /// One entry a row.
    pub rows: &'a mut [RowSums],
    /// Columns that are counted.
    pub columns: Range<usize>,
}

impl SumsOfRows<'_> {
    /// Adds the sum of `cells` to sum number `which` of row `y`, if this band owns the row.
    pub fn add(&mut self, y: usize, which: usize, cells: &[f32]) {
        if let Some(row) = y.checked_sub(self.first).and_then(|row| self.rows.get_mut(row)) {
            row[which] += Arch::new().dispatch(SumOfRow(&cells[self.columns.clone()]));
        }
    }
}

/// Sum of a row in sixteen interleaved partial sums, an order that vector units of any width keep. Blocks
/// of 1024 cells go to `f64` one by one, so that long rows lose nothing.
struct SumOfRow<'a>(&'a [f32]);

impl NullaryFnOnce for SumOfRow<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        const LANES: usize = 16;
        let mut sum = 0.0;
        for block in self.0.chunks(1024) {
            let mut lanes = [0.0_f32; LANES];
            let (chunks, rest) = block.as_chunks::<LANES>();
            for chunk in chunks {
                for (lane, cell) in lanes.iter_mut().zip(chunk) {
                    *lane += cell;
                }
            }
            let mut of_block = 0.0;
            for lane in lanes {
                of_block += f64::from(lane);
            }
            let mut of_rest = 0.0;
            for &cell in rest {
                of_rest += f64::from(cell);
            }
            sum += of_block + of_rest;
        }
        sum
    }
}

kernel! {
    /// Adds a plane to a sum.
    struct AddTo {
        reads { plane }
        updates { sum }
        constants { factor: f32 }
    }
    fn cell() {
        sum += factor * plane;
    }
}

/// The mean of what, for each of them, and their sums over the rows that a band owns.
pub struct RecordedMeans<'a> {
    /// Parts of each mean.
    pub parts: Means<'a>,
    /// Sums over the recorded steps, row-major.
    pub sums: Vec<&'a mut [f32]>,
}

/// Rows in flight between and within the steps of one time block.
pub struct Chain<P: Process> {
    constants: Vec<Ring>,
    /// `between[t]` holds what step `t` takes in; the last one what the passage gives out.
    between: Vec<Vec<Ring>>,
    scratch: Vec<P::Scratch>,
    row_length: usize,
}

impl<P: Process> Chain<P> {
    /// Memory for passages of up to `steps` steps.
    pub fn new(process: &P, columns: usize, steps: usize) -> Self {
        let rings = |count, depth| (0..count).map(|_| Ring::new(columns, depth)).collect::<Vec<_>>();
        // A row may be begun before the next step takes it in, and is looked back at after it did. Constants serve
        // all steps of the passage. Rings of debug builds watch over that.
        let window = process.lag() - process.begins() + process.look_back() + 1;
        let passage = steps.saturating_sub(1) * process.lag() + process.look_back() + 1;
        Self {
            constants: rings(process.constant_planes(), passage),
            between: (0..=steps).map(|_| rings(process.state_planes(), window)).collect(),
            scratch: (0..steps).map(|_| process.scratch(columns)).collect(),
            row_length: columns,
        }
    }
}

/// One time block over a stretch of rows.
pub struct TimeBlock<'a, P: Process> {
    /// What is computed.
    pub process: &'a P,
    /// Weather of each step of the passage.
    pub weather: &'a [P::Weather],
    /// Rows to compute, halos included.
    pub span: Range<usize>,
    /// First row of the span that this band owns.
    pub first: usize,
    /// The rows that this band owns, changed in place.
    pub own: &'a mut [PlaneRow],
    /// Copies of the rows above those, of which nothing is left.
    pub above: &'a mut [PlaneRow],
    /// Copies of the rows below those, of which nothing is left.
    pub below: &'a mut [PlaneRow],
    /// Sums of each row that this band owns.
    pub sums: &'a mut [RowSums],
    /// Columns of which the sums are counted.
    pub columns: Range<usize>,
    /// Means to which each of the steps counts.
    pub means: RecordedMeans<'a>,
}

impl<P: Process> TimeBlock<'_, P> {
    /// Advances the owned rows by one step for each entry of `weather`.
    pub fn run(mut self, chain: &mut Chain<P>) {
        if cfg!(debug_assertions) {
            // Nothing of an earlier passage is there to be read.
            *chain = Chain::new(self.process, chain.row_length, chain.scratch.len());
        }
        let lag = self.process.lag();
        let steps = self.weather.len();
        // A step may look at the row before the one that it finishes: that is given out a row later.
        let behind = steps * lag + self.process.look_back().min(1);
        for tick in self.span.start..self.span.end + behind {
            if tick < self.span.end {
                self.take_in(chain, tick);
            }
            for step in 0..steps {
                let Some(y) = tick.checked_sub(step * lag) else { continue };
                if (self.span.start..self.span.end + lag).contains(&y) {
                    self.advance(chain, step, y);
                    if let Some(done) = y.checked_sub(lag).filter(|done| *done >= self.span.start) {
                        self.record(&chain.between[step + 1], done);
                    }
                }
            }
            if let Some(done) = tick.checked_sub(behind) {
                self.give_out(&mut chain.between[steps], done);
            }
        }
        let depth = chain.constants.first().map_or(0, Ring::depth);
        for y in self.span.end.saturating_sub(depth).max(self.span.start)..self.span.end {
            self.give_constants_back(chain, y);
        }
    }

    fn advance(&mut self, chain: &mut Chain<P>, step: usize, y: usize) {
        let (before, after) = chain.between.split_at_mut(step + 1);
        self.process.advance(&mut Flow {
            constants: &chain.constants,
            input: &before[step],
            output: &mut after[0],
            scratch: &mut chain.scratch[step],
            weather: self.weather[step],
            y,
            span: self.span.clone(),
            sums: &mut SumsOfRows { first: self.first, rows: self.sums, columns: self.columns.clone() },
        });
    }

    /// Adds a row that a step has finished to the means. What a mean takes from the row south of its own comes a row
    /// later, and before the next step adds to it.
    fn record(&mut self, rings: &[Ring], y: usize) {
        let RecordedMeans { parts, sums } = &mut self.means;
        for (sum, parts) in sums.iter_mut().zip(*parts) {
            for Part { plane, factor, from: [east, south] } in *parts {
                let row = y.checked_sub(self.first + south).filter(|row| *row < self.own.len());
                let ring = &rings[*plane];
                let plane = if *east == 0 { ring.here(y) } else { ring.east(y) };
                if let Some(row) = row {
                    let sum = &mut sum[row * plane.len()..][..plane.len()];
                    AddTo { plane, sum, factor: *factor }.run(Arch::new());
                }
            }
        }
    }

    fn row(&mut self, y: usize) -> &mut PlaneRow {
        let own_end = self.first + self.own.len();
        if y < self.first {
            &mut self.above[y - self.span.start]
        } else if y < own_end {
            &mut self.own[y - self.first]
        } else {
            &mut self.below[y - own_end]
        }
    }

    /// Rows change hands with their memory: what a ring no longer needs lies in the row's place until the same row
    /// comes back changed. Constant planes go back to where they were.
    fn take_in(&mut self, chain: &mut Chain<P>, y: usize) {
        let depth = chain.constants.first().map_or(0, Ring::depth);
        if let Some(past) = y.checked_sub(depth).filter(|past| *past >= self.span.start) {
            self.give_constants_back(chain, past);
        }
        let rings = chain.between[0].iter_mut().chain(&mut chain.constants);
        for (ring, plane) in rings.zip(self.row(y)) {
            ring.take_in(y, plane);
        }
    }

    fn give_constants_back(&mut self, chain: &mut Chain<P>, y: usize) {
        let state = self.process.state_planes();
        for (ring, plane) in chain.constants.iter_mut().zip(&mut self.row(y)[state..]) {
            ring.give_out(y, plane);
        }
    }

    fn give_out(&mut self, rings: &mut [Ring], y: usize) {
        if (self.first..self.first + self.own.len()).contains(&y) {
            for (ring, plane) in rings.iter_mut().zip(self.row(y)) {
                ring.give_out(y, plane);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_sum_what_a_plain_loop_sums() {
        let cells: Vec<f32> = (0..5000).map(|i| ((i * 37) % 101) as f32 - 50.0).collect();
        let plain: f64 = cells.iter().map(|&cell| f64::from(cell)).sum();
        assert_eq!(Arch::new().dispatch(SumOfRow(&cells)), plain);
    }
}
