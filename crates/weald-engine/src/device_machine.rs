//! A whole simulation in a device's memory. The state stays there; only what is asked for comes back.

use super::device::{Device, Loaded, Window};
use super::machine::{Machine, Snapshot};
use super::program::{Buffer, Content, Program};
use super::uniform::Uniform;
use crate::stencil::chain::{RowSums, SUMS};
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
    program: Program,
    loaded: Box<dyn Loaded>,
    size: Size,
    /// Constant planes, and the sums that were there before this machine began.
    before: Snapshot,
}

impl DeviceMachine {
    /// Loads the program and uploads the start.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails or has too little memory.
    pub fn new(program: Program, start: &Snapshot, device: &dyn Device) -> Result<Self, Error> {
        let size = start.size();
        let loaded = device.load(&program, size)?;
        let mut machine = Self { program, loaded, size, before: start.clone() };
        machine.put(start)?;
        Ok(machine)
    }

    fn put(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.loaded.begin(self.size, &Window::whole(self.size))?;
        upload(&self.program, &mut *self.loaded, snapshot)?;
        self.before.clone_from(snapshot);
        self.loaded.keep()
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

impl<W: Uniform> Machine<W> for DeviceMachine {
    fn block(&self) -> usize {
        1
    }

    fn advance(&mut self, weather: &[W], recorded: bool) -> Result<(), Error> {
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
        let mut now = self.before.clone();
        download(&self.program, &mut *self.loaded, &mut now)?;
        for (sum, more) in now.row_sums[0].iter_mut().zip(sums(&mut *self.loaded)?) {
            *sum += more;
        }
        Ok(now)
    }

    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.put(snapshot)
    }
}
