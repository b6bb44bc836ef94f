//! A domain tile by tile, for memory that does not hold the whole.
//!
//! The state lies in the host's memory. Each tile is given to a worker with a halo as wide as its own cells
//! can feel in the steps of one visit, so that what happens at the halo's rim does not reach them: they
//! become what they become in the whole, to the bit. Then the tiles' own cells are put together again.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::cpu::CpuMachine;
use super::device::Window;
use super::machine::{Machine, Means, Snapshot, never_kept};
use super::patch::{Patch, Patched};
use crate::stencil::chain::Process;
use crate::stencil::rows::{Layout, Rows};
use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::Size;

/// How a domain is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Plan {
    /// Most columns and rows of a tile's own cells.
    own: Size,
    /// Steps of one visit.
    steps: usize,
    /// Cells that one step reaches.
    reach: usize,
}

impl Plan {
    /// Tiles of that many own cells, with a halo that is small beside them.
    pub(crate) fn of_own(own: Size, reach: usize) -> Self {
        let steps = (own.columns.min(own.rows) / (4 * reach)).clamp(1, 4);
        Self { own, steps, reach }
    }

    /// Tiles that take no more than `most` cells with their halos. More steps a visit move the state less
    /// often between host and device, and compute more of the halo: an eighth of the side pays for both.
    pub(crate) fn of_memory(most: u64, reach: usize, size: Size) -> Result<Self, Error> {
        let rows = ((most as f64).sqrt() as usize).min(size.rows);
        let columns = (most as usize / rows.max(1)).min(size.columns);
        let steps = (rows.min(columns) / (16 * reach)).clamp(1, 32);
        let halo = 2 * reach * steps;
        if rows <= halo || columns <= halo {
            let side = rows.min(columns) as u64;
            let limit = Limit::new(Quantity::CellsPerSide, halo as u64 + 1, 0..=side);
            let subject =
                format!("a tile with its halo, in a device's memory that holds {most} cells at a time");
            let remedy = "give it more with --gpu-memory, or use --engine cpu";
            return Err(limit.of(subject).remedy(remedy).into());
        }
        Ok(Self { own: Size { columns: columns - halo, rows: rows - halo }, steps, reach })
    }

    /// Columns and rows of the largest tile with its halo.
    pub(crate) fn largest_tile(&self, size: Size) -> Size {
        let halo = 2 * self.reach * self.steps;
        Size {
            columns: (self.own.columns + halo).min(size.columns),
            rows: (self.own.rows + halo).min(size.rows),
        }
    }

    /// Own cells of every tile, from north-west to south-east.
    fn tiles(self, size: Size) -> impl Iterator<Item = Window> {
        let cut = |whole: usize, part: usize| {
            (0..whole).step_by(part).map(move |start| start..(start + part).min(whole))
        };
        cut(size.rows, self.own.rows).flat_map(move |rows| {
            cut(size.columns, self.own.columns).map(move |columns| Window { columns, rows: rows.clone() })
        })
    }

    /// A tile with the halo of `steps` steps.
    fn with_halo(self, own: &Window, steps: usize, size: Size) -> Window {
        let halo = self.reach * steps;
        let wider = |range: &std::ops::Range<usize>, most: usize| {
            range.start.saturating_sub(halo)..(range.end + halo).min(most)
        };
        Window { columns: wider(&own.columns, size.columns), rows: wider(&own.rows, size.rows) }
    }
}

/// Advances one tile.
pub(crate) trait Worker<P: Process>: Send {
    /// One step for each entry of `weather`. `tile` has all planes, and the means where steps are recorded;
    /// its sums begin at zero and count the cells of `own`, a part of it, alone.
    fn run(&mut self, tile: Snapshot, own: &Window, steps: &Visit<'_, P::Weather>)
    -> Result<Snapshot, Error>;

    /// Goes on by another process whose planes are the same.
    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error>;
}

/// What is done in one visit.
pub(crate) struct Visit<'a, W> {
    pub(crate) weather: &'a [W],
    pub(crate) recorded: bool,
}

/// The state of a simulation in the host's memory, advanced tile by tile.
pub(crate) struct Tiled<K> {
    worker: K,
    plan: Plan,
    now: Snapshot,
    /// Where the next state is put together; its constant planes are those of `now`.
    next: Rows,
    kept: Snapshot,
    /// Copies by their numbers.
    copies: BTreeMap<u64, Snapshot>,
}

impl<K> Tiled<K> {
    pub(crate) fn new(worker: K, start: &Snapshot, plan: Plan) -> Self {
        let (now, next, kept) = (start.clone(), start.state.clone(), start.clone());
        Self { worker, plan, now, next, kept, copies: BTreeMap::new() }
    }

    fn visit<P: Process>(&mut self, steps: &Visit<'_, P::Weather>) -> Result<(), Error>
    where
        K: Worker<P>,
    {
        let size = self.now.size();
        for own in self.plan.tiles(size) {
            let with_halo = self.plan.with_halo(&own, steps.weather.len(), size);
            let tile = self.cut_out(&with_halo, steps.recorded);
            let inner = inner(&own, &with_halo);
            let done = self.worker.run(tile, &inner, steps)?;
            self.put_in(&own, &inner, &done);
        }
        std::mem::swap(&mut self.now.state, &mut self.next);
        Ok(())
    }

    /// A copy of a part of the domain.
    fn cut_out(&self, window: &Window, with_means: bool) -> Snapshot {
        let state = &self.now.state;
        let layout = Layout { columns: window.columns.len(), ..state.layout };
        let mut part = Rows::new(layout, window.rows.len());
        for (y, from) in window.rows.clone().enumerate() {
            for plane in 0..layout.planes {
                let cells = &state.plane(from, plane)[window.columns.clone()];
                part.plane_mut(y, plane).copy_from_slice(cells);
            }
        }
        let mut part = Snapshot::start(part, 0);
        let cut = |mean: &Vec<f32>| {
            let row = |y: usize| &mean[y * state.layout.columns..][window.columns.clone()];
            window.rows.clone().flat_map(row).copied().collect()
        };
        if with_means {
            part.means = self.now.means.iter().map(cut).collect();
        }
        part
    }

    /// Takes a tile's own cells over. No cell's mean depends on another's, so means need no second copy.
    fn put_in(&mut self, own: &Window, inner: &Window, done: &Snapshot) {
        let layout = self.next.layout;
        for (y, from) in own.rows.clone().zip(inner.rows.clone()) {
            for plane in 0..layout.planes {
                let cells = &done.state.plane(from, plane)[inner.columns.clone()];
                self.next.plane_mut(y, plane)[own.columns.clone()].copy_from_slice(cells);
            }
            for (sum, more) in self.now.row_sums[y].iter_mut().zip(&done.row_sums[from]) {
                *sum += more;
            }
            for (mean, more) in self.now.means.iter_mut().zip(&done.means) {
                let more = &more[from * done.state.layout.columns..][inner.columns.clone()];
                mean[y * layout.columns..][own.columns.clone()].copy_from_slice(more);
            }
        }
    }
}

/// A window counted from the corner of another.
fn inner(window: &Window, outer: &Window) -> Window {
    let inside = |range: &std::ops::Range<usize>, start: usize| range.start - start..range.end - start;
    Window {
        columns: inside(&window.columns, outer.columns.start),
        rows: inside(&window.rows, outer.rows.start),
    }
}

impl<K> Patched for Tiled<K> {
    fn patch(&mut self, window: &Window) -> Result<Patch, Error> {
        self.now.patch(window)
    }

    fn lay(&mut self, patch: &Patch) -> Result<(), Error> {
        self.now.lay(patch)
    }
}

impl<P: Process, K: Worker<P>> Machine<P> for Tiled<K> {
    fn block(&self) -> usize {
        self.plan.steps
    }

    fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error> {
        for weather in weather.chunks(self.plan.steps) {
            self.visit::<P>(&Visit { weather, recorded })?;
        }
        Ok(())
    }

    fn note(&self) -> Option<String> {
        let (tiles, own) = (self.plan.tiles(self.now.size()).count(), self.plan.own);
        let (columns, rows) = (own.columns, own.rows);
        Some(format!("ran tile by tile: {tiles} tiles of up to {columns} x {rows} cells"))
    }

    fn first_not_finite(&mut self) -> Result<Option<[usize; 3]>, Error> {
        Ok(self.now.state.first_not_finite(self.now.state.layout.planes))
    }

    fn keep(&mut self) -> Result<(), Error> {
        self.kept.clone_from(&self.now);
        Ok(())
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.now.clone_from(&self.kept);
        Ok(())
    }

    fn snapshot(&mut self) -> Result<Snapshot, Error> {
        Ok(self.now.clone())
    }

    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.now.clone_from(snapshot);
        self.next.clone_from(&snapshot.state);
        self.kept.clone_from(&self.now);
        Ok(())
    }

    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error> {
        self.worker.follow(process)
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.copies.insert(number, self.now.clone());
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        self.now.clone_from(self.copies.get(&number).ok_or_else(|| never_kept(number))?);
        Ok(())
    }

    fn release(&mut self, number: u64) {
        self.copies.remove(&number);
    }

    fn bytes_of_copy(&self) -> u64 {
        self.now.bytes() as u64
    }

    fn clear_means(&mut self) -> Result<(), Error> {
        self.now.means.iter_mut().for_each(|mean| mean.fill(0.0));
        Ok(())
    }
}

/// Tiles on the CPU, each a subdomain with walls.
pub(crate) struct CpuTiles<P> {
    pub(crate) process: Arc<P>,
    pub(crate) means: Means<'static>,
}

impl<P: Process> Worker<P> for CpuTiles<P> {
    fn run(
        &mut self,
        tile: Snapshot,
        own: &Window,
        steps: &Visit<'_, P::Weather>,
    ) -> Result<Snapshot, Error> {
        let process = Arc::new(self.process.sized(tile.size()));
        let mut machine =
            CpuMachine::new(&process, self.means, &tile, None).count_columns(own.columns.clone());
        machine.advance(steps.weather, steps.recorded)?;
        Ok(machine.into_parts())
    }

    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error> {
        self.process = Arc::clone(process);
        Ok(())
    }
}
