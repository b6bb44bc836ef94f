//! The state of a simulation, cut into bands of rows that advance side by side.
//!
//! On the CPU engine the bands share one memory and copy the rows around their edges before each passage.
//! On the bands engine each band owns its memory and receives those rows as messages: what the ranks of a
//! cluster do. Both call the same passage, and give the same bits.

use std::ops::Range;

use rayon::prelude::*;

use super::Engine;
use crate::stencil::chain::{Chain, Passage, Process, RowSums, SUMS, Strip, SumsOfRows};
use crate::stencil::ring::CACHE_LINE;
use crate::stencil::rows::{Layout, Rows};

/// A simulation's rows, bands and sums.
pub(crate) struct World<'a, P: Process> {
    process: &'a P,
    layout: Layout,
    rows: usize,
    bands: Vec<Band<P>>,
    strips: Vec<Strip>,
    /// Most steps of one passage.
    block: usize,
    /// Whether bands own their memory.
    owned: bool,
    shared: Rows,
}

/// A stretch of rows and what it needs to advance alone.
struct Band<P: Process> {
    own: Range<usize>,
    /// The band's rows, where bands own their memory; else empty.
    memory: Vec<f32>,
    above: Vec<f32>,
    below: Vec<f32>,
    /// Columns west of the next strip as they were, and those of the strip in work.
    west: [Vec<f32>; 2],
    chain: Chain<P>,
    sums: Vec<RowSums>,
}

impl<'a, P: Process> World<'a, P> {
    /// A world over `state`, whose layout holds state planes and then constant planes.
    pub(crate) fn new(process: &'a P, state: Rows, engine: Engine) -> Self {
        let rows = state.count();
        let wanted = match engine {
            Engine::Cpu => rayon::current_num_threads(),
            Engine::Bands(count) => count,
        };
        let count = wanted.clamp(1, (rows / process.reach()).max(1));
        let columns = state.layout.columns;
        let block = steps_in_a_passage(process, columns, rows / count);
        let strips = strips(columns, process.reach() * block);
        let computed = strips[0].computed.len();
        let bands = (0..count)
            .map(|band| Band {
                own: rows * band / count..rows * (band + 1) / count,
                memory: Vec::new(),
                above: Vec::new(),
                below: Vec::new(),
                west: [Vec::new(), Vec::new()],
                chain: Chain::new(process, computed, block),
                sums: vec![[0.0; SUMS]; (rows * (band + 1) / count - rows * band / count) * strips.len()],
            })
            .collect();
        let owned = matches!(engine, Engine::Bands(_));
        let mut world =
            Self { process, layout: state.layout, rows, bands, strips, block, owned, shared: state };
        world.deal_out();
        world
    }

    /// Steps that one passage can do.
    pub(crate) fn block(&self) -> usize {
        self.block
    }

    /// Replaces the state; sums stay.
    pub(crate) fn set_state(&mut self, state: &Rows) {
        self.shared.memory.resize(state.memory.len(), 0.0);
        self.shared.memory.copy_from_slice(&state.memory);
        self.deal_out();
    }

    /// Copies the state of all rows over `into`, which has the same layout.
    pub(crate) fn copy_state(&self, into: &mut Rows) {
        let mut rest = into.memory.as_mut_slice();
        for part in self.parts() {
            let (mine, others) = rest.split_at_mut(part.len());
            mine.copy_from_slice(part);
            rest = others;
        }
    }

    /// Adds `factor` times a plane to `sum`, row-major.
    pub(crate) fn add_plane_to(&self, plane: usize, factor: f32, sum: &mut [f32]) {
        for (row, sum) in self.rows().zip(sum.chunks_exact_mut(self.layout.columns)) {
            for (sum, value) in sum.iter_mut().zip(self.layout.plane(row, plane)) {
                *sum += factor * value;
            }
        }
    }

    /// Column, row and plane of the first value that is a NaN or an infinity, over the first `planes` planes.
    pub(crate) fn first_not_finite(&self, planes: usize) -> Option<(usize, usize, usize)> {
        // A fold over all cells, rather than a search, is what the compiler turns into vector code.
        let finite = |row: &[f32]| row.iter().fold(true, |all, value| all & value.is_finite());
        self.rows().enumerate().find_map(|(y, row)| {
            let plane = (0..planes).find(|&plane| !finite(self.layout.plane(row, plane)))?;
            let x = self.layout.plane(row, plane).iter().position(|value| !value.is_finite())?;
            Some((x, y, plane))
        })
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
    pub(crate) fn state(&self) -> Rows {
        let memory = self.parts().flatten().copied().collect();
        Rows { layout: self.layout, memory }
    }

    /// Sums over all rows, added from north to south whatever the bands.
    pub(crate) fn sums(&self) -> RowSums {
        let mut total = [0.0; SUMS];
        for row in self.bands.iter().flat_map(|band| &band.sums) {
            for (total, sum) in total.iter_mut().zip(row) {
                *total += sum;
            }
        }
        total
    }

    /// Sums of each row, for a checkpoint.
    pub(crate) fn row_sums(&self) -> Vec<f64> {
        self.bands.iter().flat_map(|band| band.sums.iter().flatten().copied()).collect()
    }

    /// Puts back the sums of each row.
    pub(crate) fn set_row_sums(&mut self, sums: &[f64]) {
        let rows = self.bands.iter_mut().flat_map(|band| &mut band.sums);
        for (row, saved) in rows.zip(sums.chunks_exact(SUMS)) {
            row.copy_from_slice(saved);
        }
    }

    /// Advances all rows by one step for each entry of `weather`, in passages of at most [`World::block`].
    pub(crate) fn advance(&mut self, weather: &[P::Weather]) {
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
        let Self { process, layout, strips, owned, shared, bands, .. } = self;
        let (process, layout, strips): (&P, _, &[Strip]) = (process, *layout, strips);
        let mut rest = shared.memory.as_mut_slice();
        let mut work = Vec::with_capacity(bands.len());
        for band in bands {
            let own = if *owned { std::mem::take(&mut band.memory) } else { Vec::new() };
            let mine = if *owned { 0 } else { band.own.len() * layout.row_length() };
            let (shared_part, others) = std::mem::take(&mut rest).split_at_mut(mine);
            rest = others;
            work.push((band, own, shared_part));
        }
        let common = Common { process, layout, strips, weather };
        work.into_par_iter().for_each(|(band, mut memory, shared_part)| {
            let own = if memory.is_empty() { shared_part } else { memory.as_mut_slice() };
            band.pass(&common, own);
            band.memory = memory;
        });
    }
}

/// What all bands share in a passage.
struct Common<'a, P: Process> {
    process: &'a P,
    layout: Layout,
    strips: &'a [Strip],
    weather: &'a [P::Weather],
}

impl<P: Process> Band<P> {
    /// Advances the band strip by strip. A strip keeps what its eastern neighbour needs of its old columns.
    fn pass(&mut self, common: &Common<'_, P>, own: &mut [f32]) {
        let length = common.layout.row_length();
        let Self { above, below, west, chain, sums, .. } = self;
        for (number, strip) in common.strips.iter().enumerate() {
            west.swap(0, 1);
            if let Some(next) = common.strips.get(number + 1) {
                keep_columns(common.layout, own, next.computed.start..next.own.start, &mut west[1]);
            }
            Passage {
                process: common.process,
                layout: common.layout,
                weather: common.weather,
                span: self.own.start - above.len() / length..self.own.end + below.len() / length,
                first: self.own.start,
                own: &mut *own,
                above: &*above,
                below: &*below,
                strip,
                west: &west[0],
                sums: SumsOfRows {
                    first: self.own.start,
                    columns: strip.own.start - strip.computed.start..strip.own.end - strip.computed.start,
                    strip: number,
                    strips: common.strips.len(),
                    rows: &mut *sums,
                },
            }
            .run(chain);
        }
    }
}

/// Copies some columns of all planes and rows.
fn keep_columns(layout: Layout, rows: &[f32], columns: Range<usize>, into: &mut Vec<f32>) {
    into.clear();
    for row in rows.chunks_exact(layout.row_length()) {
        for plane in 0..layout.planes {
            into.extend_from_slice(&layout.plane(row, plane)[columns.clone()]);
        }
    }
}

/// Widest strip: with the rows in flight of several steps it fits a core's second-level cache.
const WIDEST_STRIP: usize = 480;

/// Cuts columns into strips that each compute as many, with at least `halo` beyond their own on either side
/// or a wall. The cut depends on the width of the grid alone, and so does the order of sums.
fn strips(columns: usize, halo: usize) -> Vec<Strip> {
    let count = if columns <= WIDEST_STRIP + WIDEST_STRIP / 3 { 1 } else { columns.div_ceil(WIDEST_STRIP) };
    let bound = |strip: usize| {
        if strip == count { columns } else { columns / CACHE_LINE * strip / count * CACHE_LINE }
    };
    let widest = (0..count).map(|strip| bound(strip + 1) - bound(strip)).max().unwrap_or(columns);
    let computed = (widest + 2 * halo.next_multiple_of(CACHE_LINE)).min(columns);
    let strip = |number| {
        let own = bound(number)..bound(number + 1);
        let start = own.start.saturating_sub(halo.next_multiple_of(CACHE_LINE)).min(columns - computed);
        Strip { own, computed: start..start + computed }
    };
    (0..count).map(strip).collect()
}

/// As many steps as keep the rows in flight within a core's second-level cache, and the halos small beside
/// the band. The number changes nothing but the speed.
fn steps_in_a_passage<P: Process>(process: &P, columns: usize, rows_of_band: usize) -> usize {
    const CACHE_BYTES: usize = 640 << 10;
    const ROWS_A_PLANE: usize = 7;
    let planes = 2 * process.state_planes() + process.constant_planes();
    let bytes_a_step = (columns.min(WIDEST_STRIP) + 64) * size_of::<f32>() * planes * ROWS_A_PLANE;
    let by_cache = (CACHE_BYTES / bytes_a_step).clamp(1, 8);
    by_cache.min((rows_of_band / (4 * process.reach())).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_cover_all_columns_once_and_compute_their_halos() {
        for columns in [1, 17, 480, 640, 641, 1000, 1024, 2049, 16384] {
            for halo in [1, 16, 40] {
                let strips = strips(columns, halo);
                assert_eq!(strips[0].own.start, 0);
                assert_eq!(strips.last().map(|strip| strip.own.end), Some(columns));
                assert!(strips.windows(2).all(|pair| pair[0].own.end == pair[1].own.start));
                for Strip { own, computed } in &strips {
                    assert_eq!(computed.len(), strips[0].computed.len(), "all compute as many");
                    assert!(computed.start == 0 || own.start - computed.start >= halo);
                    assert!(computed.end == columns || computed.end - own.end >= halo);
                }
                // A strip keeps old columns for its eastern neighbour alone, so these must be its own.
                assert!(strips.windows(2).all(|pair| pair[1].computed.start >= pair[0].own.start));
            }
        }
    }
}
