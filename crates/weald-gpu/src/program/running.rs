//! A program on the device, with its state.

use std::ops::Range;

use weald::Error;
use weald::engine::device::{Loaded, Window};
use weald::engine::program::{COUNTED, Content, GROUP, Program};
use weald::error::{DeviceError, DeviceErrorKind};
use weald::grid::Size;
use wgpu::BufferUsages;

use super::bound_passes::{BoundPass, PassResources, Submission};
use super::buffers::Buffers;
use super::extents::{self, Extents};
use super::parts::{Bound, Cursor, Part, Work};
use super::state_copy::{Extent, NumberedCopies, StateCopy, is_state};
use super::uniforms::Uniforms;
use super::watch::Watch;
use crate::gpu::{Gpu, Shown};
use crate::memory::Store;
use crate::pace::{Load, Pace, WorkKind};
use crate::transfer::{self, Transfer};

/// A loaded program.
#[derive(Debug)]
pub(crate) struct Running {
    gpu: Gpu,
    program: Program,
    /// The grid that there is memory for, and the one that it works on.
    room: Extents,
    now: Extents,
    buffers: Buffers,
    sums: Store,
    uniforms: Uniforms,
    passes: Vec<BoundPass>,
    pace: Pace,
    transfer: Transfer,
    watch: Watch,
    kept: StateCopy,
    copies: NumberedCopies,
}

impl Running {
    /// Compiles a program and makes its buffers.
    pub(crate) fn new(gpu: Gpu, program: &Program, size: Size) -> Result<Self, Error> {
        Extents::of(size, 1).check(&gpu, program)?;
        let uniforms = Uniforms::new(&gpu, program)?;
        let room = Extents::of(size, uniforms.grid.count());
        let buffers = Buffers::new(&gpu, program, size)?;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let sums = Store::new(&gpu, "the sums", room.sums_bytes(), usage)?;
        let passes =
            PassResources { program, uniforms: &uniforms, buffers: &buffers, sums: &sums }.ready(&gpu)?;
        let (transfer, watch, pace) = (Transfer::new(&gpu)?, Watch::new(&gpu)?, Pace::new(gpu.most_moved));
        let mut running = Self {
            program: program.clone(),
            room,
            now: room,
            buffers,
            sums,
            uniforms,
            passes,
            pace,
            transfer,
            watch,
            kept: StateCopy::default(),
            copies: NumberedCopies::new(),
            gpu,
        };
        running.clear(|_| true)?;
        running.begin(size, &Window::whole(size))?;
        Ok(running)
    }

    /// Sets buffers of some contents to zero.
    fn clear(&mut self, which: impl Fn(&Content) -> bool) -> Result<(), Error> {
        for (number, buffer) in self.program.buffers.iter().enumerate() {
            if which(&buffer.content) {
                let store = self.buffers.now(number);
                let bytes = extents::bytes(buffer, self.now.size);
                transfer::clear(&self.gpu, &mut self.pace, &store.buffer, bytes)?;
            }
        }
        Ok(())
    }

    /// Shows ground and water to those who look on.
    fn show(&self) -> Result<(), Error> {
        let (Some(shows), Some(shown)) = (&self.gpu.shows, self.program.shown) else { return Ok(()) };
        let lanes = |buffer: usize| self.program.buffers[buffer].lanes as u32;
        let store = |buffer: usize| &self.buffers.now(buffer).buffer;
        shows.take(
            &self.gpu,
            self.now.size,
            &Shown {
                base: store(shown.base),
                added: (store(shown.added), lanes(shown.added)),
                water: shown.water.map(|water| (store(water), lanes(water))),
                mask: self.program.mask.map(|mask| (store(mask), lanes(mask))),
            },
        )
    }

    /// What now plays the role of a buffer, and the bytes that count.
    fn store(&self, buffer: usize) -> Result<Extent<'_>, Error> {
        let found = self.program.buffers.get(buffer).ok_or_else(|| {
            let (name, count) = (self.program.name, self.program.buffers.len());
            misused(format!("`{name}` has {count} buffers, not one with number {buffer}"))
        })?;
        Ok((self.buffers.now(buffer), extents::bytes(found, self.now.size)))
    }

    /// The stretches of bytes of a rectangle in a buffer of cells.
    fn runs(&self, buffer: usize, window: &Window) -> Result<Vec<Range<u64>>, Error> {
        self.store(buffer)?;
        let ([columns, rows], found) =
            ([self.now.size.columns, self.now.size.rows], &self.program.buffers[buffer]);
        if window.columns.end > columns
            || window.rows.end > rows
            || matches!(found.content, Content::Table(_))
        {
            let message = format!("`{}` has no cells {window:?} on {columns} × {rows}", found.name);
            return Err(misused(message));
        }
        let (planes, lanes) = if found.layered { (found.lanes, 1) } else { (1, found.lanes) };
        let run = |plane: usize, row: usize| {
            let first = plane * columns * rows + row * columns;
            let byte = |column: usize| (4 * lanes * (first + column)) as u64;
            byte(window.columns.start)..byte(window.columns.end)
        };
        Ok((0..planes).flat_map(|plane| window.rows.clone().map(move |row| run(plane, row))).collect())
    }

    /// All steps in as many submissions as their length takes.
    fn submit_all(&mut self, work: &Work, weather: &[Vec<u32>]) -> Result<(), Error> {
        let mut cursor = Cursor::default();
        while cursor.step < work.steps {
            let first = cursor.step;
            let bound =
                Bound { bytes: self.pace.allowance(WorkKind::Passes), steps: self.uniforms.weather.count() };
            let (parts, bytes) = work.next(&mut cursor, bound);
            let Some(last) = parts.last() else { break };
            let words = weather[first..=last.step].iter().map(Vec::as_slice);
            let packed = self.uniforms.weather.packed(words)?;
            self.submit(&parts, bytes, &packed)?;
        }
        Ok(())
    }

    fn submit(&mut self, parts: &[Part], bytes: u64, weather: &[u8]) -> Result<(), Error> {
        let Self { gpu, uniforms, pace, passes, buffers, now, .. } = self;
        let staged = gpu.memory.hold(weather.len() as u64, "staging")?;
        let sees_weather = !self.program.weather.name.is_empty();
        let round = Submission { passes, uniforms, extents: *now, odd: buffers.odd(), sees_weather };
        let load = Load { sort: WorkKind::Passes, bytes, staged: Some(staged) };
        pace.submit(gpu, load, |encoder| {
            gpu.context.queue.write_buffer(&uniforms.weather.store.buffer, 0, weather);
            round.encode(encoder, parts);
        })
    }
}

/// All that [`Loaded::keep`] copies, as buffers now play their roles.
fn state<'a>(program: &Program, buffers: &'a Buffers, sums: &'a Store, now: Extents) -> Vec<Extent<'a>> {
    contents(is_state, program, buffers, sums, now)
}

/// All that [`Loaded::keep_as`] copies: strokes may change constant planes too.
fn everything<'a>(program: &Program, buffers: &'a Buffers, sums: &'a Store, now: Extents) -> Vec<Extent<'a>> {
    let counts = |content: &Content| is_state(content) || matches!(content, Content::Constant(_));
    contents(counts, program, buffers, sums, now)
}

fn contents<'a>(
    counts: impl Fn(&Content) -> bool,
    program: &Program,
    buffers: &'a Buffers,
    sums: &'a Store,
    now: Extents,
) -> Vec<Extent<'a>> {
    let numbered = program.buffers.iter().enumerate().filter(|(_, buffer)| counts(&buffer.content));
    let extents = numbered.map(|(at, buffer)| (buffers.now(at), extents::bytes(buffer, now.size)));
    extents.chain([(sums, now.sums_bytes())]).collect()
}

fn misused(message: String) -> Error {
    DeviceError::new(DeviceErrorKind::Misused, message).into()
}

impl Loaded for Running {
    fn begin(&mut self, size: Size, own: &Window) -> Result<(), Error> {
        let now = Extents::of(size, self.uniforms.grid.count());
        now.check(&self.gpu, &self.program)?;
        if !self.room.hold(now) {
            let ([columns, rows], room) = ([size.columns, size.rows], self.room.size);
            return Err(misused(format!(
                "`{}` was loaded for {room} cells and cannot begin on {columns} × {rows}",
                self.program.name
            )));
        }
        self.pace.drain(&self.gpu)?;
        self.uniforms.set_grid(&self.gpu, now, own)?;
        self.now = now;
        self.buffers.set_odd(false);
        self.kept.forget();
        self.clear(|content| *content == Content::Mean)?;
        self.clear_sums()
    }

    fn write(&mut self, buffer: usize, values: &[f32]) -> Result<(), Error> {
        let (store, bytes) = self.store(buffer)?;
        if 4 * values.len() as u64 != bytes {
            let (name, given) = (self.program.buffers[buffer].name, values.len());
            return Err(misused(format!("buffer `{name}` takes {} numbers, not {given}", bytes / 4)));
        }
        transfer::write(&self.gpu, &store.buffer, bytemuck::cast_slice(values))
    }

    fn read(&mut self, buffer: usize) -> Result<Vec<f32>, Error> {
        let bytes = self.store(buffer)?.1;
        let store = self.buffers.now(buffer);
        self.transfer.read(&self.gpu, &mut self.pace, &store.buffer, bytes)
    }

    fn run(&mut self, weather: &[Vec<u32>], recorded: bool) -> Result<(), Error> {
        let cells = (self.now.unit * GROUP * self.now.size.columns) as u64;
        let running = self.passes.iter().enumerate().filter(|(_, pass)| recorded || !pass.recorded);
        let passes = running.map(|(number, pass)| (number, cells * pass.bytes_per_cell)).collect();
        self.submit_all(&Work { passes, steps: weather.len(), units: self.now.units() }, weather)?;
        self.buffers.set_odd(self.buffers.odd() ^ (weather.len() % 2 == 1));
        self.show()
    }

    fn sums(&mut self) -> Result<Vec<f64>, Error> {
        let bytes = self.now.sums_bytes();
        let values = self.transfer.read(&self.gpu, &mut self.pace, &self.sums.buffer, bytes)?;
        let mut sums = vec![0.0; COUNTED];
        for group in values.chunks_exact(2 * COUNTED) {
            for (sum, counted) in sums.iter_mut().zip(group.chunks_exact(2)) {
                *sum += f64::from(counted[0]) + f64::from(counted[1]);
            }
        }
        Ok(sums)
    }

    fn clear_sums(&mut self) -> Result<(), Error> {
        transfer::clear(&self.gpu, &mut self.pace, &self.sums.buffer, self.now.sums_bytes())
    }

    fn first_not_finite(&mut self, buffer: usize) -> Result<Option<usize>, Error> {
        let bytes = self.store(buffer)?.1;
        let searched = (&self.buffers.now(buffer).buffer, bytes / 4);
        self.watch.first(&self.gpu, &mut self.pace, &self.transfer, searched)
    }

    fn keep(&mut self) -> Result<(), Error> {
        let state = state(&self.program, &self.buffers, &self.sums, self.now);
        self.kept.keep(&self.gpu, &mut self.pace, &state)
    }

    fn go_back(&mut self) -> Result<(), Error> {
        let state = state(&self.program, &self.buffers, &self.sums, self.now);
        self.kept.go_back(&self.gpu, &mut self.pace, &state)
    }

    fn write_part(&mut self, buffer: usize, window: &Window, values: &[f32]) -> Result<(), Error> {
        let runs = self.runs(buffer, window)?;
        let wanted: u64 = runs.iter().map(|run| run.end - run.start).sum();
        if 4 * values.len() as u64 != wanted {
            let (name, given) = (self.program.buffers[buffer].name, values.len());
            return Err(misused(format!("a part of `{name}` takes {} numbers, not {given}", wanted / 4)));
        }
        let store = self.buffers.now(buffer);
        transfer::write_runs(&self.gpu, &store.buffer, &runs, bytemuck::cast_slice(values))
    }

    fn read_part(&mut self, buffer: usize, window: &Window) -> Result<Vec<f32>, Error> {
        let runs = self.runs(buffer, window)?;
        let store = self.buffers.now(buffer);
        self.transfer.read_runs(&self.gpu, &mut self.pace, &store.buffer, &runs)
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.copies.remove(&number);
        let mut copy = StateCopy::default();
        let state = everything(&self.program, &self.buffers, &self.sums, self.now);
        copy.keep(&self.gpu, &mut self.pace, &state)?;
        self.copies.insert(number, copy);
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        let state = everything(&self.program, &self.buffers, &self.sums, self.now);
        match self.copies.get(&number) {
            Some(copy) => copy.go_back(&self.gpu, &mut self.pace, &state),
            None => {
                Err(misused(format!("the GPU was asked to go back to copy {number}, which was never kept")))
            }
        }
    }

    fn release(&mut self, number: u64) {
        // Its memory counts as held until the device no longer copies from it.
        if self.copies.contains_key(&number) {
            let _ = self.pace.drain(&self.gpu);
            self.copies.remove(&number);
        }
    }

    fn clear_means(&mut self) -> Result<(), Error> {
        self.clear(|content| *content == Content::Mean)
    }

    fn set_constants(&mut self, words: &[u32]) -> Result<(), Error> {
        self.pace.drain(&self.gpu)?;
        self.uniforms.set_constants(&self.gpu, words)
    }

    fn show(&mut self) -> Result<(), Error> {
        Self::show(self)
    }
}

impl Drop for Running {
    /// Memory counts as held until the device no longer works on it.
    fn drop(&mut self) {
        let _ = self.pace.drain(&self.gpu);
    }
}
