//! The state of a simulation, cut into bands of rows that advance side by side.
//!
//! Each band owns its memory and receives the rows around its edges as messages before each time block: what the ranks
//! of a cluster do. Any number of bands gives the same bits.

mod cut;
mod inside_first;

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use crate::stencil::chain::{Chain, Process, RecordedMeans, RowSums, SUMS, TimeBlock};
use crate::stencil::rows::{Layout, Rows, first_not_finite};
use crate::stencil::segment::{PlaneRow, Segment};
use crate::sums::Means;
use cut::Cut;
pub(crate) use inside_first::Edges;

/// A simulation's rows, bands and sums.
pub struct BandedGrid<P: Process> {
    process: Arc<P>,
    layout: Layout,
    rows: usize,
    bands: Vec<Band<P>>,
    /// Whether the first and the last band can advance after the others.
    edges: [bool; 2],
    /// Most steps of one time block.
    block: usize,
    /// How many bands there are to be; `None` for one a thread.
    wanted: Option<usize>,
    /// Columns of which sums are counted.
    columns: Range<usize>,
}

/// A stretch of rows and what it needs to advance alone.
struct Band<P: Process> {
    own: Range<usize>,
    rows: Vec<PlaneRow>,
    /// Copies of the rows above and below it.
    above: Vec<PlaneRow>,
    below: Vec<PlaneRow>,
    chain: Chain<P>,
    sums: Vec<RowSums>,
}

impl<P: Process> Band<P> {
    fn new(own: Range<usize>, (rows, sums): (Vec<PlaneRow>, Vec<RowSums>), chain: Chain<P>) -> Self {
        Self { own, rows, above: Vec::new(), below: Vec::new(), chain, sums }
    }
}

/// A band, and its part of each mean.
type BandWithMeans<'a, P> = (&'a mut Band<P>, Vec<&'a mut [f32]>);

/// What all bands do in one time block.
struct BandWork<'a, P: Process> {
    process: &'a P,
    weather: &'a [P::Weather],
    parts: Means<'a>,
    columns: Range<usize>,
}

impl<P: Process> BandWork<'_, P> {
    /// Advances the rows of a band, and counts to its part of the means.
    fn run(&self, (band, means): BandWithMeans<'_, P>) {
        let Band { own, rows, above, below, chain, sums } = band;
        let Self { process, weather, parts, ref columns } = *self;
        let span = own.start - above.len()..own.end + below.len();
        let (first, columns) = (own.start, columns.clone());
        let means = RecordedMeans { parts, sums: means };
        TimeBlock { process, weather, span, first, own: rows, above, below, sums, columns, means }.run(chain);
    }
}

impl<P: Process> BandedGrid<P> {
    /// A world over `state`, whose layout holds state planes and then constant planes: in that many bands, or one a
    /// thread. Sums count the cells of `columns` alone.
    pub fn new(process: &Arc<P>, state: &Rows, wanted: Option<usize>, columns: Range<usize>) -> Self {
        let (rows, layout, process) = (state.count(), state.layout, Arc::clone(process));
        let (bands, edges) = (Vec::new(), [false; 2]);
        let mut world = Self { process, layout, rows, bands, edges, block: 1, wanted, columns };
        let count = world.even_count();
        let cut = Cut::even(rows, count);
        world.block = steps_per_time_block(&*world.process, rows / count);
        world.bands = cut
            .bands
            .into_par_iter()
            .map(|own| {
                let rows = own.clone().map(|_| empty(layout)).collect();
                let sums = vec![[0.0; SUMS]; own.len()];
                Band::new(own, (rows, sums), Chain::new(&*world.process, layout.columns, world.block))
            })
            .collect();
        world.set_state(state, layout.planes);
        world
    }

    /// How many bands there are without edges.
    fn even_count(&self) -> usize {
        let most = self.wanted.unwrap_or_else(rayon::current_num_threads);
        most.clamp(1, (self.rows / self.process.reach()).max(1))
    }

    /// Cuts the rows into other bands, for time blocks of at most so many steps. No row is copied.
    fn cut_anew(&mut self, cut: &Cut, steps: usize) {
        let (mut rows, mut sums) = (Vec::with_capacity(self.rows), Vec::with_capacity(self.rows));
        for band in self.bands.drain(..) {
            rows.extend(band.rows);
            sums.extend(band.sums);
        }
        let (mut rows, mut sums) = (rows.into_iter(), sums.into_iter());
        for own in &cut.bands {
            let taken = (rows.by_ref().take(own.len()).collect(), sums.by_ref().take(own.len()).collect());
            let chain = Chain::new(&*self.process, self.layout.columns, steps);
            self.bands.push(Band::new(own.clone(), taken, chain));
        }
        (self.edges, self.block) = (cut.edges, steps);
    }

    /// Steps that one time block can do.
    pub fn block(&self) -> usize {
        self.block
    }

    /// Counts the sums of these columns alone from now on.
    pub fn count_columns(&mut self, columns: Range<usize>) {
        self.columns = columns;
    }

    /// The place of row `y`: its band, and its number there.
    fn place(&self, y: usize) -> (usize, usize) {
        let band = self.bands.partition_point(|band| band.own.end <= y);
        (band, y - self.bands[band].own.start)
    }

    fn row(&self, y: usize) -> &PlaneRow {
        let (band, row) = self.place(y);
        &self.bands[band].rows[row]
    }

    /// Row `y` of one plane.
    pub fn plane(&self, y: usize, plane: usize) -> &[f32] {
        self.row(y)[plane].here()
    }

    /// The same, to be changed.
    pub fn plane_mut(&mut self, y: usize, plane: usize) -> &mut [f32] {
        let (band, row) = self.place(y);
        self.bands[band].rows[row][plane].here_mut()
    }

    /// State planes and constant planes.
    pub fn planes(&self) -> usize {
        self.layout.planes
    }

    /// Columns of which sums are counted.
    pub fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// How many bands were asked for; `None` for one a thread.
    pub fn wanted(&self) -> Option<usize> {
        self.wanted
    }

    /// Replaces the first planes of the state; sums stay.
    pub fn set_state(&mut self, state: &Rows, planes: usize) {
        self.bands.par_iter_mut().for_each(|band| {
            for (row, y) in band.rows.iter_mut().zip(band.own.clone()) {
                for (plane, segment) in row.iter_mut().enumerate().take(planes) {
                    segment.here_mut().copy_from_slice(state.plane(y, plane));
                }
            }
        });
    }

    /// Copies the first planes of all rows over those of `into`, which has the same layout.
    pub fn copy_state(&self, into: &mut Rows, planes: usize) {
        let layout = self.layout;
        into.memory.par_chunks_exact_mut(layout.row_length()).enumerate().for_each(|(y, into)| {
            for (plane, segment) in self.row(y).iter().enumerate().take(planes) {
                layout.plane_mut(into, plane).copy_from_slice(segment.here());
            }
        });
    }

    /// Column, row and plane of the first value that is a NaN or an infinity, over the first `planes` planes.
    pub fn first_not_finite(&self, planes: usize) -> Option<[usize; 3]> {
        self.first_not_finite_in(0..self.rows, planes)
    }

    /// The same within some rows.
    pub fn first_not_finite_in(&self, rows: Range<usize>, planes: usize) -> Option<[usize; 3]> {
        first_not_finite(rows.into_par_iter(), planes, |y, plane| self.plane(y, plane))
    }

    /// A copy of the state of all rows.
    pub fn state(&self) -> Rows {
        let mut state = Rows::new(self.layout, self.rows);
        self.copy_state(&mut state, self.layout.planes);
        state
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

    /// Advances all rows by one step for each entry of `weather`, in passages of at most [`BandedGrid::block`]. Each step
    /// counts to the `means`, row-major, of these parts.
    pub fn advance(&mut self, weather: &[P::Weather], parts: Means<'_>, means: &mut [Vec<f32>]) {
        for passage in weather.chunks(self.block) {
            self.exchange_halos(self.halo(passage.len(), parts));
            let (work, bands) = self.work(passage, parts, means);
            bands.into_par_iter().for_each(|band| work.run(band));
        }
    }

    /// Rows around its own that a band needs for so many steps.
    fn halo(&self, steps: usize, parts: Means<'_>) -> usize {
        let south = parts.iter().copied().flatten().map(|part| part.from[1]).max().unwrap_or(0);
        self.process.reach() * steps + south
    }

    /// Every band gets so many rows around its own.
    fn exchange_halos(&mut self, halo: usize) {
        let taken = |band: &mut Band<P>| [&mut band.above, &mut band.below].map(std::mem::take);
        let mut halos: Vec<_> = self.bands.iter_mut().map(taken).collect();
        halos.par_iter_mut().zip(&self.bands).for_each(|([above, below], band)| {
            self.copy_rows(band.own.start.saturating_sub(halo)..band.own.start, above);
            self.copy_rows(band.own.end..(band.own.end + halo).min(self.rows), below);
        });
        for (band, [above, below]) in self.bands.iter_mut().zip(halos) {
            (band.above, band.below) = (above, below);
        }
    }

    fn copy_rows(&self, wanted: Range<usize>, into: &mut Vec<PlaneRow>) {
        into.resize_with(wanted.len(), || empty(self.layout));
        for (y, row) in wanted.zip(into) {
            for (copy, segment) in row.iter_mut().zip(self.row(y)) {
                copy.here_mut().copy_from_slice(segment.here());
            }
        }
    }

    /// A time block, and each band with its part of the means.
    fn work<'a>(
        &'a mut self,
        weather: &'a [P::Weather],
        parts: Means<'a>,
        means: &'a mut [Vec<f32>],
    ) -> (BandWork<'a, P>, Vec<BandWithMeans<'a, P>>) {
        let width = self.layout.columns;
        let mut rest: Vec<_> = means.iter_mut().map(Vec::as_mut_slice).collect();
        let with_means = |band: &'a mut Band<P>| {
            let cells = band.own.len() * width;
            let own = rest.iter_mut().map(|rest| rest.split_off_mut(..cells).expect("a sum a cell"));
            let own = own.collect::<Vec<_>>();
            (band, own)
        };
        let bands = self.bands.iter_mut().map(with_means).collect();
        (BandWork { process: &self.process, weather, parts, columns: self.columns.clone() }, bands)
    }
}

fn empty(layout: Layout) -> PlaneRow {
    (0..layout.planes).map(|_| Segment::new(layout.columns)).collect()
}

/// Steps of a time block: four were fastest, or within 3 % of it, for every process on grids from 512² to 4096².
/// Fewer pass through memory too often; more have too many rows in flight for a core's second-level cache.
/// Narrow bands take fewer, so that their halos stay small beside them. The number changes nothing but the
/// speed.
fn steps_per_time_block<P: Process>(process: &P, rows_of_band: usize) -> usize {
    (rows_of_band / (4 * process.reach())).clamp(1, 4)
}
