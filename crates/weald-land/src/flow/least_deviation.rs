//! D8-LTD: the one of eight directions that keeps a whole path nearest to the fall line, not only the next step.
//!
//! A path, which was `δ` aside of the fall line when it arrived in a cell, takes the one of the two neighbours beside the fall
//! line after which `|δ + δi|` is less ([`super::fall_lines`] has `δ1` and `δ2`). Orlandini, Moretti, Franchini, Aldighieri,
//! Testa 2003, "Path-based methods for the determination of nondispersive drainage directions in grid-based digital elevation
//! models", doi 10.1029/2002WR001639, with the λ = 1 that they advocate; that such paths become the fall lines as cells become
//! small show Orlandini, Moretti, Gavioli 2014, doi 10.1002/2013WR014606. Where paths meet, that of the largest area goes on.
//! Both neighbours are lower, so that no path comes back.
//!
//! Differs: of areas that are the same the path from the higher cell goes on; flat ground, whose directions say nothing of
//! a fall line, forgets how far a path is aside; a cell waits only for those that may drain to it, not for all that are
//! higher, so that paths are followed in parallel, and no direction depends on who came first.

use std::cmp::Ordering;
use std::sync::atomic::Ordering::{AcqRel, Relaxed};
use std::sync::atomic::{AtomicU8, AtomicU64};

use rayon::prelude::*;

use super::accumulate::set_directions;
use super::fall_lines::FallLines;
use super::surface::Surface;
use crate::flow::directions::{CELLS_PER_TASK, opposite};

/// What leaves a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Path {
    /// Cells above, and the cell itself.
    cells: u32,
    /// How far the path of most of them is aside of its fall line, in cells; to the right of who goes down is positive.
    aside: f32,
}

impl Path {
    /// The code that a cell takes, and the path that leaves it, by the paths that arrive, each with its donor, and the levels
    /// of those.
    #[inline]
    pub(super) fn through(
        lines: &FallLines,
        cell: usize,
        arriving: impl Iterator<Item = (Self, usize)>,
        level: impl Fn(usize) -> f32,
    ) -> (u8, Self) {
        let (mut cells, mut main, mut donor) = (1_u32, Self::default(), 0);
        for (path, from) in arriving {
            cells = cells.saturating_add(path.cells);
            let is_alike = path.cells == main.cells && path.cells > 0;
            let rank = |path: Self, donor| (level(donor), -path.aside.abs());
            let order = if is_alike { rank(path, from).partial_cmp(&rank(main, donor)) } else { None };
            if path.cells > main.cells || order == Some(Ordering::Greater) {
                (main, donor) = (path, from);
            } else if order == Some(Ordering::Equal) && path.aside != main.aside {
                // Two that mirror each other.
                main.aside = 0.0;
            }
        }
        let (code, aside) = lines.taken(cell, main.aside);
        (code, Self { cells, aside })
    }

    /// As one number.
    pub(super) fn bits(self) -> u64 {
        u64::from(self.cells) << 32 | u64::from(self.aside.to_bits())
    }

    /// From that number.
    pub(super) fn from_bits(bits: u64) -> Self {
        Self { cells: (bits >> 32) as u32, aside: f32::from_bits(bits as u32) }
    }
}

/// Follows all paths over a surface whose cells drain by such codes in D8, over flat ground too.
pub(super) fn follow(surface: &Surface, steepest: &[u8]) -> Paths {
    let lines = FallLines::of(surface, steepest);
    Walk { surface, donors: lines.donors(surface), lines }.paths()
}

/// The paths that leave all cells, with the ring.
pub(super) struct Paths(Vec<AtomicU64>);

impl Paths {
    /// The code by which the path leaves a cell that is no outlet.
    pub(super) fn code(&self, cell: usize) -> u8 {
        code_of(self.0[cell].load(Relaxed))
    }

    /// Cells above a cell, and the cell itself.
    pub(super) fn cells(&self, cell: usize) -> u32 {
        path_of(self.0[cell].load(Relaxed)).cells
    }
}

/// Bits of the cells of a path in memory: a grid there has at most 2^28 of them.
const CELL_BITS: u32 = 29;

/// A path and the code by which it leaves, as one number.
fn packed(code: u8, path: Path) -> u64 {
    // Nothing goes on from an outlet or in the sea, whose code no cell asks for.
    u64::from(code.saturating_sub(1)) << (32 + CELL_BITS) | path.bits()
}

fn code_of(packed: u64) -> u8 {
    (packed >> (32 + CELL_BITS)) as u8 + 1
}

fn path_of(packed: u64) -> Path {
    Path::from_bits(packed & ((1 << (32 + CELL_BITS)) - 1))
}

/// Paths on their way down.
struct Walk<'a> {
    surface: &'a Surface,
    lines: FallLines,
    /// The neighbours from which each cell may receive.
    donors: Vec<u8>,
}

impl Walk<'_> {
    fn paths(&self) -> Paths {
        let cells = || (0..self.donors.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
        let left: Vec<AtomicU64> = cells().map(|_| AtomicU64::new(0)).collect();
        let waiting: Vec<AtomicU8> =
            cells().map(|cell| AtomicU8::new(self.donors[cell].count_ones() as u8)).collect();
        let offsets = self.surface.offsets();
        let heads = cells().filter(|&cell| self.donors[cell] == 0);
        heads.for_each_init(Vec::new, |open, head| {
            open.push(head);
            while let Some(cell) = open.pop() {
                self.pass(cell, (&left, &waiting, &offsets), open);
            }
        });
        Paths(left)
    }

    /// Finishes a cell, and finds those for which it was the last to wait for.
    #[inline]
    fn pass(
        &self,
        cell: usize,
        (left, waiting, offsets): (&[AtomicU64], &[AtomicU8], &[isize; 8]),
        open: &mut Vec<usize>,
    ) {
        let beside = |direction: usize| cell.wrapping_add_signed(offsets[direction]);
        let arriving = set_directions(self.donors[cell]).map(|direction| {
            let donor = beside(direction);
            let packed = left[donor].load(Relaxed);
            let comes = code_of(packed) == opposite(direction as u8) + 1;
            // Without a branch, which nothing foresees: what goes elsewhere is a path of no cells.
            (path_of(if comes { packed } else { 0 }), donor)
        });
        let (code, path) = Path::through(&self.lines, cell, arriving, |donor| self.surface.level[donor]);
        left[cell].store(packed(code, path), Relaxed);
        for direction in set_directions(self.lines.receivers[cell]) {
            let next = beside(direction);
            // The counter hands the paths of those who came before over to the last.
            if self.donors[next].is_power_of_two() || waiting[next].fetch_sub(1, AcqRel) == 1 {
                open.push(next);
            }
        }
    }
}
