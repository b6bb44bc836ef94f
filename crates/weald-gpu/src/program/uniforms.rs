//! What every pass of a program sees beside its buffers: the grid, the constants, the weather.

use weald::Error;
use weald::engine::device::Window;
use weald::engine::program::{GROUP, Program};

use super::extents::Extents;
use crate::gpu::Gpu;
use crate::slots::{self, Slots};
use crate::transfer::{self, piece_bytes};

/// Words of the struct `Grid` of the prelude.
const GRID_WORDS: usize = 8;

/// Most steps of one submission, and most places where a dispatch may begin.
const MAX_SLOTS: usize = 1024;

/// The uniforms of a program.
#[derive(Debug)]
pub(crate) struct Uniforms {
    /// A slot for each place where a dispatch may begin.
    pub(crate) grid: Slots,
    pub(crate) constants: Slots,
    /// A slot for each step of a submission.
    pub(crate) weather: Slots,
}

impl Uniforms {
    pub(crate) fn new(gpu: &Gpu, program: &Program) -> Result<Self, Error> {
        let count = |words| slots::fitting(gpu, words, piece_bytes(gpu)).min(MAX_SLOTS);
        let words = &program.constants.words;
        let constants = Slots::new(gpu, "the constants", words.len(), 1)?;
        let packed = constants.packed(std::iter::once(words.as_slice()))?;
        transfer::write(gpu, &constants.store.buffer, &packed)?;
        let words = program.weather.words.len();
        Ok(Self {
            grid: Slots::new(gpu, "the grid's uniform", GRID_WORDS, count(GRID_WORDS))?,
            constants,
            weather: Slots::new(gpu, "the weather's uniform", words, count(words))?,
        })
    }

    /// Replaces the constants by as many other words.
    pub(crate) fn set_constants(&self, gpu: &Gpu, words: &[u32]) -> Result<(), Error> {
        let packed = self.constants.packed(std::iter::once(words))?;
        transfer::write(gpu, &self.constants.store.buffer, &packed)
    }

    /// Says on which grid the passes work, and whose sums count.
    pub(crate) fn set_grid(&self, gpu: &Gpu, extents: Extents, own: &Window) -> Result<(), Error> {
        let size = extents.size;
        let (columns, rows) = (&own.columns, &own.rows);
        let grid = |first_row| {
            [
                size.columns,
                size.rows,
                columns.start,
                rows.start,
                columns.end,
                rows.end,
                first_row,
                extents.across,
            ]
            .map(|word| word as u32)
        };
        let places: Vec<_> = (0..extents.units()).map(|unit| grid(unit * extents.unit * GROUP)).collect();
        let packed = self.grid.packed(places.iter().map(<[u32; GRID_WORDS]>::as_slice))?;
        transfer::write(gpu, &self.grid.store.buffer, &packed)
    }
}
