//! A whole simulation in a device's memory. The state stays there; only what is asked for comes back.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::device::{Device, Loaded, Window};
use super::machine::{Machine, Snapshot, never_kept};
use super::patch::{Patch, Patched};
use super::program::{Buffer, Content, Program};
use super::uniform::Uniform;
use crate::stencil::chain::{Process, RowSums, SUMS};
use crate::stencil::rows::{Layout, Rows};
use weald_core::error::Error;
use weald_core::grid::Size;

/// Part of a device's memory that is left for staging, uniforms and sums.
const RESERVED: u64 = 8;

/// Cells that a device holds of a program at once, with the copy that is kept to go back to.
pub fn most_cells(program: &Program, device: &dyn Device) -> u64 {
    let memory = (device.memory() - device.memory() / RESERVED).saturating_sub(program.table_bytes());
    let bytes = program.bytes_per_cell() + program.bytes_kept_per_cell();
    (memory / bytes as u64).min(device.largest_buffer() / program.widest_buffer() as u64)
}

/// The state of a simulation on a device.
pub struct DeviceMachine {
    device: Arc<dyn Device>,
    program: Program,
    loaded: Box<dyn Loaded>,
    size: Size,
    /// Constant planes, and the sums that were there before this machine began.
    before: Snapshot,
    /// Whether constant planes have changed on the device since they were uploaded.
    painted: bool,
    /// Sums of the first row in `before` when a copy was kept, by its number.
    kept_sums: BTreeMap<u64, RowSums>,
}

impl DeviceMachine {
    /// Loads the program and uploads the start.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails or has too little memory.
    pub fn new(program: Program, start: &Snapshot, device: &Arc<dyn Device>) -> Result<Self, Error> {
        let size = start.size();
        let loaded = device.load(&program, size)?;
        let (before, kept_sums) = (start.clone(), BTreeMap::new());
        let device = Arc::clone(device);
        let mut machine = Self { device, program, loaded, size, before, painted: false, kept_sums };
        machine.put(start)?;
        Ok(machine)
    }

    fn put(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.loaded.begin(self.size, &Window::whole(self.size))?;
        upload(&self.program, &mut *self.loaded, snapshot)?;
        self.before.clone_from(snapshot);
        self.painted = false;
        self.loaded.keep()
    }

    /// A copy of everything.
    fn copy(&mut self) -> Result<Snapshot, Error> {
        let mut now = self.before.clone();
        download(&self.program, &mut *self.loaded, &mut now)?;
        if self.painted {
            self.download_constants(&mut now)?;
        }
        for (sum, more) in now.row_sums[0].iter_mut().zip(sums(&mut *self.loaded)?) {
            *sum += more;
        }
        Ok(now)
    }

    fn download_constants(&mut self, into: &mut Snapshot) -> Result<(), Error> {
        for (number, buffer) in self.program.buffers.iter().enumerate() {
            let Content::Constant(planes) = &buffer.content else { continue };
            let values = self.loaded.read(number)?;
            for (lane, &plane) in planes.iter().enumerate() {
                into.state.scatter(plane, &lane_of(buffer, lane, &values));
            }
        }
        Ok(())
    }

    /// What is kept in buffers that are to go, in the host's memory.
    fn copies_that_are_kept(&mut self) -> Result<Vec<(u64, Snapshot)>, Error> {
        self.painted = true;
        let kept: Vec<_> = self.kept_sums.iter().map(|(&number, &sums)| (number, sums)).collect();
        let mut copies = Vec::with_capacity(kept.len());
        for (number, sums) in kept {
            self.loaded.return_to(number)?;
            self.before.row_sums[0] = sums;
            copies.push((number, self.copy()?));
        }
        Ok(copies)
    }

    /// Buffers with planes of the state, and which planes they are.
    fn buffers(&self) -> Vec<(usize, Vec<usize>)> {
        let planes = |content: &Content| match content {
            Content::State(planes) | Content::Constant(planes) => Some(planes.clone()),
            _ => None,
        };
        let buffers = self.program.buffers.iter().enumerate();
        buffers.filter_map(|(number, buffer)| Some((number, planes(&buffer.content)?))).collect()
    }

    /// Puts those planes of a patch that a buffer holds over those of the buffer.
    fn lay_into(&mut self, (number, planes): (usize, &[usize]), patch: &Patch) -> Result<(), Error> {
        let among = |plane: &usize| patch.planes.iter().position(|held| held == plane);
        if !planes.iter().any(|plane| among(plane).is_some()) {
            return Ok(());
        }
        let buffer = &self.program.buffers[number];
        let now = if planes.iter().all(|plane| among(plane).is_some()) {
            Vec::new()
        } else {
            self.loaded.read_part(number, &patch.window)?
        };
        let lanes: Vec<_> = (0..buffer.lanes)
            .map(|lane| match planes.get(lane).and_then(among) {
                Some(at) => patch.rows.gather(at),
                None => lane_of(buffer, lane, &now),
            })
            .collect();
        self.painted |= matches!(buffer.content, Content::Constant(_));
        self.loaded.write_part(number, &patch.window, &packed(buffer, &lanes))
    }
}

/// Writes all buffers that hold planes or means.
pub fn upload(program: &Program, loaded: &mut dyn Loaded, from: &Snapshot) -> Result<(), Error> {
    let mut means = from.means.iter();
    for (number, buffer) in program.buffers.iter().enumerate() {
        match &buffer.content {
            Content::State(planes) | Content::Constant(planes) => {
                let planes: Vec<_> = planes.iter().map(|&plane| from.state.gather(plane)).collect();
                loaded.write(number, &packed(buffer, &planes))?;
            }
            Content::Mean => {
                let lanes: Vec<_> = means.by_ref().take(buffer.lanes).cloned().collect();
                if !lanes.is_empty() {
                    loaded.write(number, &packed(buffer, &lanes))?;
                }
            }
            Content::Scratch | Content::Table(_) => {}
        }
    }
    Ok(())
}

/// Reads all state planes, and as many means as `into` has.
pub fn download(program: &Program, loaded: &mut dyn Loaded, into: &mut Snapshot) -> Result<(), Error> {
    let mut means = into.means.iter_mut();
    for (number, buffer) in program.buffers.iter().enumerate() {
        match &buffer.content {
            Content::State(planes) => {
                let values = loaded.read(number)?;
                for (lane, &plane) in planes.iter().enumerate() {
                    into.state.scatter(plane, &lane_of(buffer, lane, &values));
                }
            }
            Content::Mean if means.len() > 0 => {
                let values = loaded.read(number)?;
                let lanes = means.by_ref().take(buffer.lanes).enumerate();
                lanes.for_each(|(lane, mean)| *mean = lane_of(buffer, lane, &values));
            }
            _ => {}
        }
    }
    Ok(())
}

/// The sums of a device, which does not keep rows apart.
pub fn sums(loaded: &mut dyn Loaded) -> Result<RowSums, Error> {
    let mut sums = [0.0; SUMS];
    for (sum, value) in sums.iter_mut().zip(loaded.sums()?) {
        *sum = value;
    }
    Ok(sums)
}

/// Lanes as a buffer holds them.
fn packed(buffer: &Buffer, lanes: &[Vec<f32>]) -> Vec<f32> {
    if buffer.layered || lanes.len() == 1 {
        return lanes.concat();
    }
    let cells = lanes.first().map_or(0, Vec::len);
    (0..cells).flat_map(|cell| lanes.iter().map(move |lane| lane[cell])).collect()
}

fn lane_of(buffer: &Buffer, lane: usize, values: &[f32]) -> Vec<f32> {
    if buffer.layered {
        let cells = values.len() / buffer.lanes;
        return values[lane * cells..][..cells].to_vec();
    }
    values.iter().skip(lane).step_by(buffer.lanes).copied().collect()
}

/// Cell and plane of a value in a buffer.
fn place(buffer: &Buffer, planes: &[usize], index: usize, size: Size) -> [usize; 3] {
    let (cell, lane) = if buffer.layered {
        (index % size.cells(), index / size.cells())
    } else {
        (index / buffer.lanes, index % buffer.lanes)
    };
    [cell % size.columns, cell / size.columns, planes[lane]]
}

impl Patched for DeviceMachine {
    fn patch(&mut self, window: &Window) -> Result<Patch, Error> {
        let layout = Layout { columns: window.columns.len(), planes: self.before.state.layout.planes };
        let mut rows = Rows::new(layout, window.rows.len());
        for (number, planes) in self.buffers() {
            let values = self.loaded.read_part(number, window)?;
            let buffer = &self.program.buffers[number];
            for (lane, &plane) in planes.iter().enumerate() {
                rows.scatter(plane, &lane_of(buffer, lane, &values));
            }
        }
        let planes = (0..layout.planes).collect();
        Ok(Patch { window: window.clone(), planes, rows, sums: self.before.row_sums[0] })
    }

    fn lay(&mut self, patch: &Patch) -> Result<(), Error> {
        for (number, planes) in self.buffers() {
            self.lay_into((number, &planes), patch)?;
        }
        self.before.row_sums[0] = patch.sums;
        self.loaded.show()
    }
}

impl<P: Process> Machine<P> for DeviceMachine {
    fn block(&self) -> usize {
        1
    }

    fn advance(&mut self, weather: &[P::Weather], recorded: bool) -> Result<(), Error> {
        let words: Vec<_> = weather.iter().map(Uniform::words).collect();
        self.loaded.run(&words, recorded)
    }

    fn first_not_finite(&mut self) -> Result<Option<[usize; 3]>, Error> {
        for (number, buffer) in self.program.buffers.iter().enumerate() {
            if let Content::State(planes) = &buffer.content
                && let Some(index) = self.loaded.first_not_finite(number)?
            {
                return Ok(Some(place(buffer, planes, index, self.size)));
            }
        }
        Ok(None)
    }

    fn keep(&mut self) -> Result<(), Error> {
        self.loaded.keep()
    }

    fn go_back(&mut self) -> Result<(), Error> {
        self.loaded.go_back()
    }

    fn snapshot(&mut self) -> Result<Snapshot, Error> {
        self.copy()
    }

    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.put(snapshot)
    }

    fn follow(&mut self, process: &Arc<P>) -> Result<(), Error> {
        let program = process.program();
        if self.program.differs_in_numbers_alone(&program) {
            self.loaded.set_constants(&program.constants.words)?;
            self.program = program;
            return Ok(());
        }
        let now = self.copy()?;
        let copies = self.copies_that_are_kept()?;
        self.loaded = self.device.load(&program, self.size)?;
        self.program = program;
        for (number, copy) in copies {
            self.put(&copy)?;
            self.loaded.keep_as(number)?;
            self.kept_sums.insert(number, copy.row_sums[0]);
        }
        self.put(&now)
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.loaded.keep_as(number)?;
        self.kept_sums.insert(number, self.before.row_sums[0]);
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        let sums = *self.kept_sums.get(&number).ok_or_else(|| never_kept(number))?;
        self.loaded.return_to(number)?;
        self.before.row_sums[0] = sums;
        // Strokes may have painted constant planes before or since.
        self.painted = true;
        self.loaded.show()
    }

    fn release(&mut self, number: u64) {
        self.kept_sums.remove(&number);
        self.loaded.release(number);
    }

    fn bytes_of_copy(&self) -> u64 {
        let kept =
            |content: &Content| matches!(content, Content::State(_) | Content::Constant(_) | Content::Mean);
        let buffers = self.program.buffers.iter().filter(|buffer| kept(&buffer.content));
        buffers.map(|buffer| 4 * buffer.length(self.size.cells()) as u64).sum()
    }

    fn clear_means(&mut self) -> Result<(), Error> {
        self.loaded.clear_means()
    }
}
