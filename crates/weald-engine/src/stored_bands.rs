//! A simulation whose state lies on disk, or of which each rank has its own rows: bands of rows that advance one after the
//! other, several steps at a time.
//!
//! A band is read with the rows around it that its cells feel in the steps of a pass, advanced as a grid of its own, and its
//! own rows are written back. The band to the south still finds the rows that were written over: they are kept for it. Rows
//! of the neighbours come from their ranks before the pass. Any cut gives the bits of the whole.

use std::ops::Range;
use std::sync::Arc;

use crate::bands::BandedGrid;
use crate::ranks::{Ranks, SharedRows, agreed, joined, total};
use crate::stencil::chain::{Process, RowSums};
use crate::stencil::rows::{Layout, Rows};
use crate::stored_plane::{StoredPlane, swap_margins};
use crate::sums::Means;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::file_plane::VALUE;
use weald_core::grid::Size;

/// Most steps of a pass: more would compute more rows twice than reading and writing costs.
const MOST_STEPS: usize = 32;

/// Rows in flight of one thread, of one plane, as measured with `han`.
const ROWS_OF_A_THREAD: usize = 512;

/// Most steps that a thread does between exchanges with the others.
const STEPS_OF_A_THREAD: usize = 4;

/// Makes the constant planes of some rows, each row-major.
pub type Constants<'a> = &'a dyn Fn(Range<usize>) -> Result<Vec<Vec<f32>>, Error>;

/// Is told after each band how many rows are done, and ends the pass by an error.
pub type Passed<'a> = &'a mut dyn FnMut(usize) -> Result<(), Error>;

/// How rows are cut into bands, and steps into passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cut {
    /// Rows of a band.
    band: usize,
    /// Most steps of a pass.
    steps: usize,
}

/// The state of a simulation of which this process has its own rows.
pub struct StoredBands<P: Process> {
    process: Arc<P>,
    columns: usize,
    rows: SharedRows,
    ranks: Arc<dyn Ranks>,
    parts: Means<'static>,
    /// State planes.
    pub state: Vec<StoredPlane>,
    /// Sums over the recorded steps.
    pub means: Vec<StoredPlane>,
    /// Sums of each of its own rows.
    row_sums: Vec<RowSums>,
    cut: Cut,
}

/// What a simulation in bands is given beside its process.
pub struct BandsOf<'a> {
    /// Its columns and rows.
    pub grid: (usize, SharedRows),
    /// Parts of its means.
    pub means: Means<'static>,
    /// Bytes of memory that it may take.
    pub memory: u64,
    /// Makes planes of that grid, on all ranks together.
    pub plane: &'a dyn Fn() -> Result<StoredPlane, Error>,
    /// The ranks that compute it.
    pub ranks: &'a Arc<dyn Ranks>,
}

impl<P: Process> StoredBands<P> {
    /// A state of zeros.
    ///
    /// # Errors
    /// [`Error::Limit`] where the memory holds no band; those of `plane`.
    pub fn new(process: Arc<P>, given: BandsOf<'_>) -> Result<Self, Error> {
        let BandsOf { grid: (columns, rows), means: parts, memory, plane, ranks } = given;
        let planes = [process.state_planes(), process.constant_planes(), parts.len()];
        let cut = Cut::of((columns, &rows), planes, process.reach(), memory)?;
        let made = |count: usize| (0..count).map(|_| plane()).collect::<Result<Vec<_>, _>>();
        let (state, means) = (made(planes[0])?, made(planes[2])?);
        let (ranks, row_sums) = (Arc::clone(ranks), vec![RowSums::default(); rows.own().len()]);
        Ok(Self { process, columns, rows, ranks, parts, state, means, row_sums, cut })
    }

    /// Most steps of a pass.
    pub fn steps(&self) -> usize {
        self.cut.steps
    }

    /// Most rows around a rank's own for which constants are asked.
    pub fn margin(&self) -> usize {
        halo(self.process.reach(), self.cut.steps)
    }

    /// Sums of each of its own rows.
    pub fn row_sums(&self) -> &[RowSums] {
        &self.row_sums
    }

    /// Goes on from planes and sums that another run has kept.
    ///
    /// # Errors
    /// [`Error::Run`] where they are not of this simulation.
    pub fn go_on(&mut self, planes: Vec<StoredPlane>, row_sums: Vec<RowSums>) -> Result<(), Error> {
        let states = self.state.len();
        let is_of_this = planes.len() == states + self.means.len()
            && row_sums.len() == self.row_sums.len()
            && planes.iter().zip(self.state.iter().cycle()).all(|(kept, own)| kept.is_shared_as(own));
        if !is_of_this {
            return Err(Error::Run("the state that was kept is not of this simulation".to_owned()));
        }
        self.state = planes;
        self.means = self.state.split_off(states);
        self.row_sums = row_sums;
        Ok(())
    }

    /// Sums of all rows, from north to south.
    ///
    /// # Errors
    /// [`Error::Run`] where another rank can no longer be reached.
    pub fn total(&self) -> Result<RowSums, Error> {
        total(&*self.ranks, &self.row_sums)
    }

    /// A pass: one step for each entry of `weather`, of which there are at most [`StoredBands::steps`]. Gives column, row and
    /// plane of the first value that is no number then. All ranks call it together.
    ///
    /// # Errors
    /// Those of the disk, of `constants` and of `passed` on any rank, after which the state is of no use.
    pub fn advance(
        &mut self,
        weather: &[P::Weather],
        recorded: bool,
        called: (Constants<'_>, Passed<'_>),
    ) -> Result<Option<[usize; 3]>, Error> {
        let halo = halo(self.process.reach(), weather.len());
        swap_margins(&mut self.state.iter_mut().collect::<Vec<_>>(), halo, &*self.ranks)?;
        let ranks = Arc::clone(&self.ranks);
        let wrong = agreed(&*ranks, self.pass(weather, recorded, called))?;
        let wrong = joined(&*ranks, wrong.map(|place| place.map(|of| of as f64)), |first, _| first)?;
        Ok(wrong.map(|place| place.map(|of| of as usize)))
    }

    /// The same for its own rows.
    fn pass(
        &mut self,
        weather: &[P::Weather],
        recorded: bool,
        (constants, passed): (Constants<'_>, Passed<'_>),
    ) -> Result<Option<[usize; 3]>, Error> {
        let (halo, all) = (halo(self.process.reach(), weather.len()), self.rows.own());
        let mut kept: Vec<_> = self.state.iter_mut().map(StoredPlane::take_north).collect();
        let mut wrong = None;
        for start in all.clone().step_by(self.cut.band) {
            let own = start..(start + self.cut.band).min(all.end);
            let held = start.saturating_sub(halo)..(own.end + halo).min(self.rows.count());
            let mut grid = self.grid(&held, own.start, &mut kept, constants)?;
            if own.end < all.end {
                keep_for_the_next(&grid, &held, own.end, (&mut kept, halo));
            }
            let mut means = self.means_of(&own, &held, recorded)?;
            let inner = own.start - held.start..own.end - held.start;
            let mut sums = vec![RowSums::default(); held.len()];
            let saved = own.start - all.start..own.end - all.start;
            sums[inner.clone()].copy_from_slice(&self.row_sums[saved.clone()]);
            grid.set_row_sums(&sums);
            grid.advance(weather, if recorded { self.parts } else { &[] }, &mut means);
            if let Some([x, y, plane]) = grid.first_not_finite_in(inner.clone(), self.state.len()) {
                wrong = wrong.or(Some([x, y + held.start, plane]));
            }
            self.row_sums[saved].copy_from_slice(&grid.row_sums()[inner.clone()]);
            self.write_back(&grid, &own, &inner, recorded.then_some(&means))?;
            passed(own.end - all.start)?;
        }
        Ok(wrong)
    }

    /// The rows of a band and around it: those to the north as they were kept, the others from the disk.
    fn grid(
        &self,
        held: &Range<usize>,
        own: usize,
        kept: &mut [Vec<f32>],
        constants: Constants<'_>,
    ) -> Result<BandedGrid<P>, Error> {
        let columns = self.columns;
        let layout = Layout { columns, planes: self.state.len() + self.process.constant_planes() };
        let process = Arc::new(self.process.sized(Size { columns, rows: held.len() }));
        let mut grid = BandedGrid::new(&process, &Rows::new(layout, held.len()), None, 0..columns);
        for (number, (plane, kept)) in self.state.iter().zip(kept).enumerate() {
            let north = std::mem::take(kept);
            let south = plane.rows(own..held.end)?;
            let rows = north.chunks_exact(columns).chain(south.chunks_exact(columns));
            for (y, row) in rows.enumerate() {
                grid.plane_mut(y, number).copy_from_slice(row);
            }
        }
        for (number, plane) in constants(held.clone())?.into_iter().enumerate() {
            for (y, row) in plane.chunks_exact(columns).enumerate() {
                grid.plane_mut(y, self.state.len() + number).copy_from_slice(row);
            }
        }
        Ok(grid)
    }

    /// The means of the rows that are held; those around the band's own are not kept.
    fn means_of(
        &self,
        own: &Range<usize>,
        held: &Range<usize>,
        recorded: bool,
    ) -> Result<Vec<Vec<f32>>, Error> {
        let columns = self.columns;
        let planes = if recorded { self.means.as_slice() } else { &[] };
        let of_plane = |plane: &StoredPlane| {
            let mut cells = vec![0.0; held.len() * columns];
            let first = (own.start - held.start) * columns;
            cells[first..first + own.len() * columns].copy_from_slice(&plane.rows(own.clone())?);
            Ok(cells)
        };
        planes.iter().map(of_plane).collect()
    }

    fn write_back(
        &mut self,
        grid: &BandedGrid<P>,
        own: &Range<usize>,
        inner: &Range<usize>,
        means: Option<&Vec<Vec<f32>>>,
    ) -> Result<(), Error> {
        let columns = self.columns;
        for (number, plane) in self.state.iter_mut().enumerate() {
            let rows: Vec<f32> = inner.clone().flat_map(|y| grid.plane(y, number).iter().copied()).collect();
            plane.set_rows(own.clone(), &rows)?;
        }
        for (plane, cells) in self.means.iter_mut().zip(means.into_iter().flatten()) {
            plane.set_rows(own.clone(), &cells[inner.start * columns..inner.end * columns])?;
        }
        Ok(())
    }
}

/// Keeps the rows that the next band has to its north, before they change.
fn keep_for_the_next<P: Process>(
    grid: &BandedGrid<P>,
    held: &Range<usize>,
    end: usize,
    (kept, halo): (&mut [Vec<f32>], usize),
) {
    for (number, kept) in kept.iter_mut().enumerate() {
        for y in end.saturating_sub(halo)..end {
            kept.extend_from_slice(grid.plane(y - held.start, number));
        }
    }
}

/// Rows around a band that its cells feel in so many steps; means may take values from one more.
fn halo(reach: usize, steps: usize) -> usize {
    reach * steps + 1
}

impl Cut {
    /// The widest bands that the memory holds with the rows around them. It is the same on all ranks.
    fn of(
        (columns, rows): (usize, &SharedRows),
        [state, constants, means]: [usize; 3],
        reach: usize,
        memory: u64,
    ) -> Result<Self, Error> {
        // The grid, the constants as they come, means, one plane on its way, and what is kept for the next band.
        let planes = state + 2 * constants + means + 2;
        // A fifth more, since allocators keep some of what one band gave back from the next.
        let row = VALUE * columns as u64 * planes as u64 * 6 / 5;
        let thread = ROWS_OF_A_THREAD + 2 * halo(reach, STEPS_OF_A_THREAD) * (state + constants);
        let threads = VALUE * (columns * thread * rayon::current_num_threads()) as u64;
        let (most, is_whole) = (rows.most(), rows.is_whole());
        // Rows of the neighbours, as they come and as they are kept.
        let margins = |steps: usize| if is_whole { 0 } else { 4 * halo(reach, steps) * (state + constants) };
        let beside = |steps: usize| threads + VALUE * (columns * margins(steps)) as u64;
        let cut = |steps: usize| {
            let held = usize::try_from(memory.saturating_sub(beside(steps)) / row).unwrap_or(usize::MAX);
            let around = 2 * halo(reach, steps);
            if held >= most + if is_whole { 0 } else { around } {
                return Some(Self { band: most, steps });
            }
            let is_worth_it = steps == 1 || steps <= held / (8 * reach);
            (held > around && is_worth_it).then(|| Self { band: held - around, steps })
        };
        (1..=Self::most_steps(rows, reach)).rev().find_map(cut).ok_or_else(|| {
            let needed = beside(1) + row * (2 * halo(reach, 1) + 1) as u64;
            let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=memory);
            let subject = format!("a band of a simulation of {columns} columns");
            limit.of(subject).remedy("allow more memory, or fewer --threads").into()
        })
    }

    /// Most steps of a pass: those for which neighbours have the rows, and no more than cost less to compute twice than to
    /// begin another pass.
    fn most_steps(rows: &SharedRows, reach: usize) -> usize {
        if rows.is_whole() {
            return MOST_STEPS;
        }
        // A mask is read one row further than the state.
        let there = rows.least().saturating_sub(2) / reach;
        let worth = (4 * rows.least() / reach).isqrt();
        there.min(worth).clamp(1, MOST_STEPS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn within_two_threads(test: impl FnOnce() + Send) {
        rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads").install(test);
    }

    #[test]
    fn bands_fit_the_memory_and_have_rows_of_their_own() {
        within_two_threads(|| {
            let rows = SharedRows::of((0, 1), 5000);
            let cut = |memory| Cut::of((1000, &rows), [5, 1, 2], 4, memory);
            assert_eq!(cut(u64::MAX / 2).expect("room"), Cut { band: 5000, steps: MOST_STEPS });
            for memory in [8 << 20, 20 << 20, 100 << 20] {
                let Cut { band, steps } = cut(memory).expect("room");
                let held = band + 2 * halo(4, steps);
                assert!(band > 0 && held as u64 * 4 * 1000 * 11 + 4 * 512 * 2 * 1000 <= memory);
                assert!(2 * halo(4, steps) <= held / 2 || steps == 1, "few rows are computed twice");
            }
            let error = cut(4 << 20).expect_err("no room").to_string();
            assert!(error.contains("1000 columns"), "{error}");
        });
    }

    #[test]
    fn a_pass_over_ranks_needs_no_rows_beyond_the_neighbours() {
        within_two_threads(|| {
            for (rows, count, reach) in [(290, 6, 4), (64, 2, 31), (5000, 3, 4), (200, 6, 9)] {
                let rows = SharedRows::of((0, count), rows).ringed(1);
                for memory in [40 << 20, u64::MAX / 2] {
                    let Cut { band, steps } = Cut::of((1000, &rows), [5, 1, 2], reach, memory).expect("room");
                    assert!(halo(reach, steps) <= rows.least(), "{rows:?}, {steps} steps");
                    assert!((1..=rows.most()).contains(&band), "{rows:?}, {band} rows");
                }
            }
        });
    }
}
