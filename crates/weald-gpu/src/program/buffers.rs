//! The buffers of a program, and which of them plays which role.

use weald::Error;
use weald::engine::program::Program;
use weald::error::{DeviceError, DeviceErrorKind};
use weald::grid::Size;
use wgpu::BufferUsages;

use super::extents::bytes;
use crate::gpu::Gpu;
use crate::memory::Store;

/// Least size of a buffer: one element of any kind, so that even an empty table can be bound.
const MIN_BYTES: u64 = 16;

/// Buffers that exchange roles after each step: what was written becomes what is read.
#[derive(Debug)]
pub(crate) struct Buffers {
    stores: Vec<Store>,
    /// The buffer that plays each one's role after an odd number of steps.
    partners: Vec<usize>,
    odd: bool,
}

impl Buffers {
    /// Allocates for grids of that size.
    pub(crate) fn new(gpu: &Gpu, program: &Program, size: Size) -> Result<Self, Error> {
        let partners = partners(program)?;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let stores = program.buffers.iter().map(|buffer| {
            let what = format!("buffer `{}` of `{}`", buffer.name, program.name);
            Store::new(gpu, &what, bytes(buffer, size).max(MIN_BYTES), usage)
        });
        Ok(Self { stores: stores.collect::<Result<_, _>>()?, partners, odd: false })
    }

    /// What now plays the role of a buffer.
    pub(crate) fn now(&self, buffer: usize) -> &Store {
        self.playing(buffer, self.odd)
    }

    /// What plays the role of a buffer after an odd or an even number of steps.
    pub(crate) fn playing(&self, buffer: usize, odd: bool) -> &Store {
        &self.stores[if odd { self.partners[buffer] } else { buffer }]
    }

    /// Whether roles are exchanged now.
    pub(crate) fn odd(&self) -> bool {
        self.odd
    }

    /// Exchanges roles, or puts them back.
    pub(crate) fn set_odd(&mut self, odd: bool) {
        self.odd = odd;
    }
}

fn partners(program: &Program) -> Result<Vec<usize>, Error> {
    let mut partners: Vec<_> = (0..program.buffers.len()).collect();
    for &[one, other] in &program.swaps {
        let alike =
            |buffer: usize| program.buffers.get(buffer).map(|buffer| (buffer.lanes, buffer.length(1)));
        let alone = [one, other].iter().all(|&buffer| partners.get(buffer) == Some(&buffer));
        if !alone || one == other || alike(one) != alike(other) {
            let message = format!(
                "`{}` swaps buffers {one} and {other}; each can be swapped once, with one of as many lanes",
                program.name
            );
            return Err(DeviceError::new(DeviceErrorKind::Misused, message).into());
        }
        partners.swap(one, other);
    }
    Ok(partners)
}
