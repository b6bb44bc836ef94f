//! The state of a simulation, cut into bands of rows that advance side by side.
//!
//! On the CPU engine the bands share one memory and copy the rows around their edges before each time block.
//! On the bands engine each band owns its memory and receives those rows as messages: what the ranks of a
//! cluster do. Both call the same time block, and give the same bits.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use crate::stencil::chain::{Chain, Process, RowSums, SUMS, TimeBlock};
use crate::stencil::rows::{Layout, Rows, first_not_finite};

/// A simulation's rows, bands and sums.
pub struct BandedGrid<P: Process> {
    process: Arc<P>,
    layout: Layout,
    rows: usize,
    bands: Vec<Band<P>>,
    /// Most steps of one time block.
    block: usize,
    /// Whether bands own their memory.
    owned: bool,
    /// Columns of which sums are counted.
    columns: Range<usize>,
    shared: Rows,
}

/// A stretch of rows and what it needs to advance alone.
struct Band<P: Process> {
    own: Range<usize>,
    /// The band's rows, where bands own their memory; else empty.
    memory: Vec<f32>,
    above: Vec<f32>,
    below: Vec<f32>,
    chain: Chain<P>,
    sums: Vec<RowSums>,
}

impl<P: Process> BandedGrid<P> {
    /// A world over `state`, whose layout holds state planes and then constant planes: in that many bands that
    /// own their memory, or one a thread that share it. Sums count the cells of `columns` alone.
    pub fn new(process: &Arc<P>, state: Rows, bands: Option<usize>, columns: Range<usize>) -> Self {
        let rows = state.count();
        let owned = bands.is_some();
        let wanted = bands.unwrap_or_else(rayon::current_num_threads);
        let count = wanted.clamp(1, (rows / process.reach()).max(1));
        let block = steps_per_time_block(&**process, rows / count);
        let bands = (0..count)
            .map(|band| Band {
                own: rows * band / count..rows * (band + 1) / count,
                memory: Vec::new(),
                above: Vec::new(),
                below: Vec::new(),
                chain: Chain::new(&**process, state.layout.columns, block),
                sums: vec![[0.0; SUMS]; rows * (band + 1) / count - rows * band / count],
            })
            .collect();
        let process = Arc::clone(process);
        let mut world =
            Self { process, layout: state.layout, rows, bands, block, owned, columns, shared: state };
        world.deal_out();
        world
    }

    /// Steps that one time block can do.
    pub fn block(&self) -> usize {
        self.block
    }

    /// Counts the sums of these columns alone from now on.
    pub fn count_columns(&mut self, columns: Range<usize>) {
        self.columns = columns;
    }

    /// The memory that holds row `y` with all its planes.
    pub fn row(&self, y: usize) -> &[f32] {
        let length = self.layout.row_length();
        let (memory, y) = match self.bands.iter().find(|band| self.owned && band.own.contains(&y)) {
            Some(band) => (&band.memory, y - band.own.start),
            None => (&self.shared.memory, y),
        };
        &memory[y * length..][..length]
    }

    /// The same, to be changed.
    pub fn row_mut(&mut self, y: usize) -> &mut [f32] {
        let length = self.layout.row_length();
        let owned = self.owned;
        let (memory, y) = match self.bands.iter_mut().find(|band| owned && band.own.contains(&y)) {
            Some(band) => (&mut band.memory, y - band.own.start),
            None => (&mut self.shared.memory, y),
        };
        &mut memory[y * length..][..length]
    }

    /// How a row lies in memory.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Columns of which sums are counted.
    pub fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// How many bands own their memory; `None` where they share it.
    pub fn owners(&self) -> Option<usize> {
        self.owned.then_some(self.bands.len())
    }

    /// Replaces the state; sums stay.
    pub fn set_state(&mut self, state: &Rows) {
        self.shared.memory.resize(state.memory.len(), 0.0);
        self.shared.memory.copy_from_slice(&state.memory);
        self.deal_out();
    }

    /// Copies the state of all rows over `into`, which has the same layout.
    pub fn copy_state(&self, into: &mut Rows) {
        let mut rest = into.memory.as_mut_slice();
        for part in self.parts() {
            let (mine, others) = rest.split_at_mut(part.len());
            mine.copy_from_slice(part);
            rest = others;
        }
    }

    /// Adds `factor` times a plane to `sum`, row-major; each cell takes the value of the cell that many columns
    /// east and rows south of it.
    pub fn add_plane_to(&self, plane: usize, from: [usize; 2], factor: f32, sum: &mut [f32]) {
        for (row, sum) in self.rows().skip(from[1]).zip(sum.chunks_exact_mut(self.layout.columns)) {
            for (sum, value) in sum.iter_mut().zip(self.layout.plane(row, plane).iter().skip(from[0])) {
                *sum += factor * value;
            }
        }
    }

    /// Column, row and plane of the first value that is a NaN or an infinity, over the first `planes` planes.
    pub fn first_not_finite(&self, planes: usize) -> Option<[usize; 3]> {
        first_not_finite(self.layout, self.rows(), planes)
    }

    /// The memory of all rows, in one part or one a band.
    fn parts(&self) -> impl Iterator<Item = &[f32]> {
        let shared = std::iter::once(self.shared.memory.as_slice());
        shared.chain(self.bands.iter().map(|band| band.memory.as_slice()))
    }

    fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.parts().flat_map(|part| part.chunks_exact(self.layout.row_length()))
    }

    /// A copy of the state of all rows.
    pub fn state(&self) -> Rows {
        let memory = self.parts().flatten().copied().collect();
        Rows { layout: self.layout, memory }
    }

    /// Sums of each row.
    pub fn row_sums(&self) -> Vec<RowSums> {
        self.bands.iter().flat_map(|band| band.sums.iter().copied()).collect()
    }

    /// Puts back the sums of each row.
    pub fn set_row_sums(&mut self, sums: &[RowSums]) {
        let rows = self.bands.iter_mut().flat_map(|band| &mut band.sums);
        for (row, saved) in rows.zip(sums) {
            row.copy_from_slice(saved);
        }
    }

    /// Advances all rows by one step for each entry of `weather`, in passages of at most [`BandedGrid::block`].
    pub fn advance(&mut self, weather: &[P::Weather]) {
        for passage in weather.chunks(self.block) {
            self.exchange_halos(passage.len());
            self.pass(passage);
        }
    }

    fn deal_out(&mut self) {
        if !self.owned {
            return;
        }
        let length = self.layout.row_length();
        for band in &mut self.bands {
            band.memory = self.shared.memory[band.own.start * length..band.own.end * length].to_vec();
        }
        self.shared.memory = Vec::new();
    }

    /// Every band gets the rows that its own depend on during the next `steps` steps.
    fn exchange_halos(&mut self, steps: usize) {
        let (halo, length, rows) = (self.process.reach() * steps, self.layout.row_length(), self.rows);
        let messages: Vec<_> = self
            .bands
            .iter()
            .map(|band| {
                let above = band.own.start.saturating_sub(halo)..band.own.start;
                let below = band.own.end..(band.own.end + halo).min(rows);
                (self.copy_rows(above, length), self.copy_rows(below, length))
            })
            .collect();
        for (band, (above, below)) in self.bands.iter_mut().zip(messages) {
            (band.above, band.below) = (above, below);
        }
    }

    fn copy_rows(&self, wanted: Range<usize>, length: usize) -> Vec<f32> {
        if !self.owned {
            return self.shared.memory[wanted.start * length..wanted.end * length].to_vec();
        }
        let part = |band: &Band<P>| {
            let start = wanted.start.max(band.own.start);
            let end = wanted.end.min(band.own.end).max(start);
            let offset = band.own.start;
            if end == start {
                return Vec::new();
            }
            band.memory[(start - offset) * length..(end - offset) * length].to_vec()
        };
        self.bands.iter().flat_map(part).collect()
    }

    fn pass(&mut self, weather: &[P::Weather]) {
        let (process, layout) = (&*self.process, self.layout);
        let length = layout.row_length();
        let mut rest = self.shared.memory.as_mut_slice();
        let mut work = Vec::with_capacity(self.bands.len());
        for band in &mut self.bands {
            let Band { own, memory, above, below, chain, sums } = band;
            let own_memory = if self.owned {
                memory.as_mut_slice()
            } else {
                let (mine, others) = std::mem::take(&mut rest).split_at_mut(own.len() * length);
                rest = others;
                mine
            };
            let span = own.start - above.len() / length..own.end + below.len() / length;
            let first = own.start;
            work.push((
                TimeBlock {
                    process,
                    layout,
                    weather,
                    span,
                    first,
                    own: own_memory,
                    above,
                    below,
                    sums,
                    columns: self.columns.clone(),
                },
                chain,
            ));
        }
        work.into_par_iter().for_each(|(passage, chain)| passage.run(chain));
    }
}

/// Steps of a time block: four were fastest, or within 3 % of it, for every process on grids from 512² to 4096².
/// Fewer pass through memory too often; more have too many rows in flight for a core's second-level cache.
/// Narrow bands take fewer, so that their halos stay small beside them. The number changes nothing but the
/// speed.
fn steps_per_time_block<P: Process>(process: &P, rows_of_band: usize) -> usize {
    (rows_of_band / (4 * process.reach())).clamp(1, 4)
}
