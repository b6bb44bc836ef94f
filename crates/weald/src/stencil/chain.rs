//! Steps of a simulation as streams of rows, chained.
//!
//! One step takes rows from north to south and gives each row back a few rows later, changed. Chaining the
//! streams of several steps advances the simulation by that many steps in one passage through memory
//! (temporal blocking by skewing). A stretch of rows is computed as a small world of its own with walls at
//! both ends; rows that lie further from an end than `reach` cells a step do not feel it, so that bands with
//! halos give the same bits as the whole, whatever the number of bands and of steps in a passage. Wide grids
//! are cut into strips of columns in the same way, so that the rows in flight stay in the cache.

use std::ops::Range;

use super::ring::Ring;
use super::rows::Layout;

/// Sums that a process keeps for each row, in the process's own order.
pub(crate) const SUMS: usize = 5;

/// What happened on one row, summed over its cells and over time.
pub(crate) type RowSums = [f64; SUMS];

/// A simulation step as a stream of rows.
pub(crate) trait Process: Sync {
    /// What differs from step to step: rain or sunshine.
    type Weather: Copy + Send + Sync;
    /// Rows in flight within one step.
    type Scratch: Send;

    /// Planes that steps change.
    fn state_planes(&self) -> usize;
    /// Planes that stay, stored behind the state planes.
    fn constant_planes(&self) -> usize;
    /// Rows by which a step's output lies behind its input.
    fn lag(&self) -> usize;
    /// Farthest row that a row of the output depends on.
    fn reach(&self) -> usize;
    /// Memory for one step over rows of this many cells.
    fn scratch(&self, columns: usize) -> Self::Scratch;
    /// Takes row `flow.y` in and finishes row `flow.y - lag` of the output.
    fn advance(&self, flow: &mut Flow<'_, '_, Self>);
}

/// Everything one step sees when a row comes in.
pub(crate) struct Flow<'a, 's, P: Process + ?Sized> {
    /// Planes that stay.
    pub(crate) constants: &'a [Ring],
    /// Rows as the step finds them.
    pub(crate) input: &'a [Ring],
    /// Rows as the step leaves them.
    pub(crate) output: &'a mut [Ring],
    /// Rows in flight.
    pub(crate) scratch: &'a mut P::Scratch,
    /// Rain or sunshine of this step.
    pub(crate) weather: P::Weather,
    /// The row that comes in; beyond `span.end` when the last rows flow out.
    pub(crate) y: usize,
    /// The rows of this small world, between its walls.
    pub(crate) span: Range<usize>,
    /// Its first column.
    pub(crate) column: usize,
    /// Sums of the rows that this band owns; the others are another band's.
    pub(crate) sums: &'a mut SumsOfRows<'s>,
}

impl<P: Process + ?Sized> Flow<'_, '_, P> {
    /// The row `behind` rows behind the newest, where it exists.
    pub(crate) fn behind(&self, behind: usize) -> Option<usize> {
        self.y.checked_sub(behind).filter(|row| self.span.contains(row))
    }

    /// The row after `y`, or `y` itself before a wall.
    pub(crate) fn next(&self, y: usize) -> usize {
        if y + 1 < self.span.end { y + 1 } else { y }
    }
}

/// Row sums of the rows that a band owns.
pub(crate) struct SumsOfRows<'a> {
    /// First row owned.
    pub(crate) first: usize,
    /// Cells of a row that count; the others are another strip's.
    pub(crate) columns: Range<usize>,
    /// Number of this strip, and of all.
    pub(crate) strip: usize,
    pub(crate) strips: usize,
    /// One entry a row and strip.
    pub(crate) rows: &'a mut [RowSums],
}

impl SumsOfRows<'_> {
    /// Adds the sum of `cells` to sum number `which` of row `y`, if this band owns the row.
    pub(crate) fn add(&mut self, y: usize, which: usize, cells: &[f32]) {
        let Some(row) = y.checked_sub(self.first) else { return };
        if let Some(sums) = self.rows.get_mut(row * self.strips + self.strip) {
            sums[which] += sum_in_lanes(&cells[self.columns.clone()]);
        }
    }
}

/// Sum of a row in sixteen interleaved partial sums, an order that vector units of any width keep. Blocks
/// of 1024 cells go to `f64` one by one, so that long rows lose nothing.
fn sum_in_lanes(cells: &[f32]) -> f64 {
    const LANES: usize = 16;
    let block_sum = |block: &[f32]| {
        let mut lanes = [0.0_f32; LANES];
        let (chunks, rest) = block.as_chunks::<LANES>();
        for chunk in chunks {
            for (lane, cell) in lanes.iter_mut().zip(chunk) {
                *lane += cell;
            }
        }
        let lanes: f64 = lanes.iter().map(|&lane| f64::from(lane)).sum();
        lanes + rest.iter().map(|&cell| f64::from(cell)).sum::<f64>()
    };
    cells.chunks(1024).map(block_sum).sum()
}

/// Rows in flight between and within the steps of one passage.
pub(crate) struct Chain<P: Process> {
    constants: Vec<Ring>,
    /// `between[t]` holds what step `t` takes in; the last one what the passage gives out.
    between: Vec<Vec<Ring>>,
    scratch: Vec<P::Scratch>,
}

impl<P: Process> Chain<P> {
    /// Memory for passages of up to `steps` steps.
    pub(crate) fn new(process: &P, columns: usize, steps: usize) -> Self {
        let rings = |count, depth| (0..count).map(|_| Ring::new(columns, depth)).collect::<Vec<_>>();
        // A row of the output may be begun `lag` rows before the next step takes it in, or be looked back at
        // for as many; no process does both at once. Constants serve all steps of the passage.
        let window = process.lag() + 1;
        Self {
            constants: rings(process.constant_planes(), steps * process.lag() + 1),
            between: (0..=steps).map(|_| rings(process.state_planes(), window)).collect(),
            scratch: (0..steps).map(|_| process.scratch(columns)).collect(),
        }
    }
}

/// A strip of columns: those that it owns, within those that it computes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Strip {
    pub(crate) own: Range<usize>,
    pub(crate) computed: Range<usize>,
}

/// One passage over a stretch of rows and a strip of columns.
pub(crate) struct Passage<'a, P: Process> {
    pub(crate) process: &'a P,
    pub(crate) layout: Layout,
    /// Weather of each step of the passage.
    pub(crate) weather: &'a [P::Weather],
    /// Rows to compute, halos included.
    pub(crate) span: Range<usize>,
    /// Rows of the span that this band owns: first row and their memory, changed in place.
    pub(crate) first: usize,
    pub(crate) own: &'a mut [f32],
    /// Copies of the rows above and below.
    pub(crate) above: &'a [f32],
    pub(crate) below: &'a [f32],
    pub(crate) strip: &'a Strip,
    /// The columns west of the strip as they were before the strip there was changed, row after row of the
    /// owned rows, plane after plane.
    pub(crate) west: &'a [f32],
    pub(crate) sums: SumsOfRows<'a>,
}

impl<P: Process> Passage<'_, P> {
    /// Advances the owned cells by one step for each entry of `weather`.
    pub(crate) fn run(mut self, chain: &mut Chain<P>) {
        let lag = self.process.lag();
        let steps = self.weather.len();
        for tick in self.span.start..self.span.end + steps * lag {
            if tick < self.span.end {
                self.take_in(chain, tick);
            }
            for step in 0..steps {
                let Some(y) = tick.checked_sub(step * lag) else { continue };
                if (self.span.start..self.span.end + lag).contains(&y) {
                    self.advance(chain, step, y);
                }
            }
            if let Some(done) = tick.checked_sub(steps * lag) {
                self.give_out(&chain.between[steps], done);
            }
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
            column: self.strip.computed.start,
            sums: &mut self.sums,
        });
    }

    fn own_end(&self) -> usize {
        self.first + self.own.len() / self.layout.row_length()
    }

    /// Copies a row into the chain: from the band's own memory or from the halo above or below.
    fn take_in(&self, chain: &mut Chain<P>, y: usize) {
        let owned = (self.first..self.own_end()).contains(&y);
        let (memory, row) = if y < self.first {
            (self.above, y - self.span.start)
        } else if owned {
            (&*self.own, y - self.first)
        } else {
            (self.below, y - self.own_end())
        };
        let length = self.layout.row_length();
        let row = &memory[row * length..][..length];
        let west = self.strip.own.start - self.strip.computed.start;
        for (plane, ring) in chain.between[0].iter_mut().chain(&mut chain.constants).enumerate() {
            let cells = ring.here_mut(y);
            cells.copy_from_slice(&self.layout.plane(row, plane)[self.strip.computed.clone()]);
            if owned && west > 0 {
                let saved = ((y - self.first) * self.layout.planes + plane) * west;
                cells[..west].copy_from_slice(&self.west[saved..][..west]);
            }
        }
    }

    fn give_out(&mut self, rings: &[Ring], y: usize) {
        if !(self.first..self.own_end()).contains(&y) {
            return;
        }
        let length = self.layout.row_length();
        let row = &mut self.own[(y - self.first) * length..][..length];
        let Strip { own, computed } = self.strip;
        for (plane, ring) in rings.iter().enumerate() {
            let cells = &ring.here(y)[own.start - computed.start..own.end - computed.start];
            self.layout.plane_mut(row, plane)[own.clone()].copy_from_slice(cells);
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
        assert_eq!(sum_in_lanes(&cells), plain);
    }
}
