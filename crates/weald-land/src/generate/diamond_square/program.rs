//! Diamond-square as a compute pass: each step doubles the lattice.

use super::{DiamondSquare, levels, windows};
use crate::generate::hash::Plane;
use weald_core::grid::Size;
use weald_engine::on_device::OnDevice;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Program, Uniforms};
use weald_engine::uniform;
use weald_engine::uniform::Uniform;

const HASH: &str = include_str!("../hash.wgsl");
const DIAMOND_SQUARE: &str = include_str!("../diamond_square.wgsl");

uniform! {
    /// One doubling of the lattice; with a side of 1 the corners alone.
    struct Level {
        /// Columns and rows of the part of the lattice that is made.
        columns: u32,
        rows: u32,
        /// Columns of the coarser lattice.
        coarse_columns: u32,
        /// Intervals along a side of the whole lattice.
        side: u32,
        /// Plane of the random numbers.
        start: u32,
        key: u32,
        amplitude: f32,
    }
}

impl DiamondSquare {
    /// The program that makes the lattice of a landscape on a grid that has room for every level's part.
    pub(super) fn lattice(&self, size: Size, seed: u64) -> OnDevice {
        let windows = windows(size, levels(size));
        let most = |side: fn(&Size) -> usize| windows.iter().map(side).max().unwrap_or(1);
        let room = Size { columns: most(|window| window.columns), rows: most(|window| window.rows) };
        let steps: Vec<_> = self.levels(&windows, seed).map(|level| level.words()).collect();
        OnDevice {
            program: program(),
            tables: Vec::new(),
            size: room,
            in_bands: false,
            steps: Box::new(move |_| steps.clone()),
            result: "coarse",
        }
    }

    fn levels(&self, windows: &[Size], seed: u64) -> impl Iterator<Item = Level> {
        windows.iter().enumerate().map(move |(number, window)| {
            let [start, key] = Plane::new(seed, number as u64).words();
            Level {
                columns: window.columns as u32,
                rows: window.rows as u32,
                coarse_columns: windows[number.saturating_sub(1)].columns as u32,
                side: 1 << number,
                start,
                key,
                amplitude: number.checked_sub(1).map_or(1.0, |level| self.amplitude(level as u32)),
            }
        })
    }
}

fn program() -> Program {
    let nothing = Level { columns: 0, rows: 0, coarse_columns: 0, side: 1, start: 0, key: 0, amplitude: 0.0 };
    let mut draft = ProgramBuilder::new(
        "diamond-square",
        &[HASH, DIAMOND_SQUARE],
        Uniforms::default(),
        Uniforms::of(&nothing),
    );
    draft.scratch("coarse", 1);
    draft.scratch("fine", 1);
    draft.pass("refine", &[], &["coarse"], &["fine"]);
    draft.swap("coarse", "fine");
    draft.finish(0)
}
