//! A simulation whose state lies on disk: bands of rows that advance one after the other, several steps at a time.
//!
//! What ranks do side by side with messages, a single machine does in turn with files. A band is read with the rows around
//! it that its cells feel in the steps of a pass, advanced as a grid of its own, and its own rows are written back. The band
//! to the south still finds the rows that were written over: they are kept for it. Any cut gives the bits of the whole.

use std::ops::Range;
use std::sync::Arc;

use crate::bands::BandedGrid;
use crate::stencil::chain::{Process, RowSums};
use crate::stencil::rows::{Layout, Rows};
use crate::sums::Means;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::file_plane::{FilePlane, VALUE};
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

/// The state of a simulation on disk.
pub struct BandsOnDisk<P: Process> {
    process: Arc<P>,
    size: Size,
    parts: Means<'static>,
    /// State planes.
    pub state: Vec<FilePlane>,
    /// Sums over the recorded steps.
    pub means: Vec<FilePlane>,
    /// Sums of each row.
    pub row_sums: Vec<RowSums>,
    cut: Cut,
}

impl<P: Process> BandsOnDisk<P> {
    /// A state of zeros on a grid of that size, advanced within so many bytes of memory. `plane` makes planes.
    ///
    /// # Errors
    /// [`Error::Limit`] where the memory holds no band; those of `plane`.
    pub fn new(
        process: Arc<P>,
        (size, parts): (Size, Means<'static>),
        memory: u64,
        plane: &dyn Fn() -> Result<FilePlane, Error>,
    ) -> Result<Self, Error> {
        let planes = [process.state_planes(), process.constant_planes(), parts.len()];
        let cut = Cut::of(size, planes, process.reach(), memory)?;
        let made = |count: usize| (0..count).map(|_| plane()).collect::<Result<Vec<_>, _>>();
        let (state, means) = (made(planes[0])?, made(planes[2])?);
        Ok(Self { process, size, parts, state, means, row_sums: vec![RowSums::default(); size.rows], cut })
    }

    /// Most steps of a pass.
    pub fn steps(&self) -> usize {
        self.cut.steps
    }

    /// A pass: one step for each entry of `weather`, of which there are at most [`BandsOnDisk::steps`]. Gives column, row and
    /// plane of the first value that is no number then.
    ///
    /// # Errors
    /// Those of the disk, of `constants` and of `passed`, after which the state is of no use.
    pub fn advance(
        &mut self,
        weather: &[P::Weather],
        recorded: bool,
        (constants, passed): (Constants<'_>, Passed<'_>),
    ) -> Result<Option<[usize; 3]>, Error> {
        let halo = halo(self.process.reach(), weather.len());
        let (mut kept, mut wrong) = (vec![Vec::new(); self.state.len()], None);
        for start in (0..self.size.rows).step_by(self.cut.band) {
            let own = start..(start + self.cut.band).min(self.size.rows);
            let held = start.saturating_sub(halo)..(own.end + halo).min(self.size.rows);
            let mut grid = self.grid(&held, own.start, &mut kept, constants)?;
            self.keep_for_the_next(&grid, &held, own.end, &mut kept, halo);
            let mut means = self.means_of(&own, &held, recorded)?;
            grid.set_row_sums(&self.row_sums[held.clone()]);
            grid.advance(weather, if recorded { self.parts } else { &[] }, &mut means);
            let inner = own.start - held.start..own.end - held.start;
            if let Some([x, y, plane]) = grid.first_not_finite_in(inner.clone(), self.state.len()) {
                wrong = wrong.or(Some([x, y + held.start, plane]));
            }
            self.row_sums[own.clone()].copy_from_slice(&grid.row_sums()[inner.clone()]);
            self.write_back(&grid, &own, &inner, recorded.then_some(&means))?;
            passed(own.end)?;
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
        let columns = self.size.columns;
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

    /// Keeps the rows that the next band has to its north, before they change.
    fn keep_for_the_next(
        &self,
        grid: &BandedGrid<P>,
        held: &Range<usize>,
        end: usize,
        kept: &mut [Vec<f32>],
        halo: usize,
    ) {
        if end == self.size.rows {
            return;
        }
        for (number, kept) in kept.iter_mut().enumerate() {
            for y in end.saturating_sub(halo)..end {
                kept.extend_from_slice(grid.plane(y - held.start, number));
            }
        }
    }

    /// The means of the rows that are held; those around the band's own are not kept.
    fn means_of(
        &self,
        own: &Range<usize>,
        held: &Range<usize>,
        recorded: bool,
    ) -> Result<Vec<Vec<f32>>, Error> {
        let columns = self.size.columns;
        let planes = if recorded { self.means.as_slice() } else { &[] };
        let of_plane = |plane: &FilePlane| {
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
        let columns = self.size.columns;
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

/// Rows around a band that its cells feel in so many steps; means may take values from one more.
fn halo(reach: usize, steps: usize) -> usize {
    reach * steps + 1
}

impl Cut {
    /// The widest bands that the memory holds with the rows around them.
    fn of(
        size: Size,
        [state, constants, means]: [usize; 3],
        reach: usize,
        memory: u64,
    ) -> Result<Self, Error> {
        // The grid, the constants as they come, means, one plane on its way, and what is kept for the next band.
        let planes = state + 2 * constants + means + 2;
        // A fifth more, since allocators keep some of what one band gave back from the next.
        let row = VALUE * size.columns as u64 * planes as u64 * 6 / 5;
        let thread = ROWS_OF_A_THREAD + 2 * halo(reach, STEPS_OF_A_THREAD) * (state + constants);
        let threads = VALUE * (size.columns * thread * rayon::current_num_threads()) as u64;
        let held = usize::try_from(memory.saturating_sub(threads) / row).unwrap_or(usize::MAX);
        if held >= size.rows {
            return Ok(Self { band: size.rows, steps: MOST_STEPS });
        }
        let steps = (held / (8 * reach)).clamp(1, MOST_STEPS);
        let least = 2 * halo(reach, 1) + 1;
        if held < least {
            let needed = threads + row * least as u64;
            let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=memory);
            let subject = format!("a band of a simulation of {} columns", size.columns);
            return Err(limit.of(subject).remedy("allow more memory, or fewer --threads").into());
        }
        Ok(Self { band: held - 2 * halo(reach, steps), steps })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_fit_the_memory_and_have_rows_of_their_own() {
        let size = Size { columns: 1000, rows: 5000 };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
        pool.install(|| {
            let cut = |memory| Cut::of(size, [5, 1, 2], 4, memory);
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
}
