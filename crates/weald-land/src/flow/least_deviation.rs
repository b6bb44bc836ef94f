//! D8-LTD: the one of eight directions that keeps a whole path nearest to the fall line, not only the next step.
//!
//! The fall line of a cell leads down the steepest of the eight triangles that it makes with its neighbours (Tarboton
//! 1997, doi 10.1029/96WR03137), between a straight neighbour 1 and a diagonal one 2. With the drops `s1` from the cell
//! to 1 and `s2` from 1 to 2, a step to one of them ends aside of the fall line by
//!
//! ```text
//! δ1 = s2 / √(s1² + s2²)      δ2 = -(s1 - s2) / √(s1² + s2²)      in cells, on two sides of it
//! ```
//!
//! and the path, which was `δ` aside when it arrived, takes the step after which `|δ + δi|` is less. Orlandini, Moretti,
//! Franchini, Aldighieri, Testa 2003, "Path-based methods for the determination of nondispersive drainage directions in
//! grid-based digital elevation models", doi 10.1029/2002WR001639, with the λ = 1 that they advocate; that such paths
//! become the fall lines as cells become small show Orlandini, Moretti, Gavioli 2014, doi 10.1002/2013WR014606. Where
//! paths meet, that of the largest area goes on. Both neighbours are lower, so that no path comes back.
//!
//! Differs: of areas that are the same the path from the higher cell goes on; flat ground, whose directions say nothing of
//! a fall line, forgets how far a path is aside; a cell waits only for those that may drain to it, not for all that are
//! higher, so that paths are followed in parallel, and no direction depends on who came first.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

use rayon::prelude::*;

use super::accumulate::set_directions;
use super::descent::Descent;
use super::surface::{NO_DATA, Surface};
use crate::flow::directions::{CELLS_PER_TASK, OUTLET, opposite};

/// Codes of the straight and the diagonal neighbour of each triangle.
const TRIANGLES: [(u8, u8); 8] = [(1, 2), (1, 8), (3, 4), (3, 2), (5, 6), (5, 4), (7, 8), (7, 6)];

/// Bits of the straight neighbours.
const STRAIGHT: u8 = 0b0101_0101;

/// The neighbours to which a cell may drain: their codes, and how far each lies aside of the fall line. A second code of 0
/// is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidates {
    codes: [u8; 2],
    aside: [f64; 2],
    /// Whether the ground tells of a fall line.
    is_flat: bool,
}

impl Candidates {
    /// Those of a cell that drains by `steepest` in D8, over flat ground too.
    pub(super) fn of(surface: &Surface, cell: usize, steepest: u8) -> Self {
        let only = |code, is_flat| Self { codes: [code, 0], aside: [0.0; 2], is_flat };
        if steepest == OUTLET {
            return only(OUTLET, true);
        }
        let next = surface.neighbour(cell, steepest);
        if surface.is_sea(next) || surface.level[next] == surface.level[cell] {
            return only(steepest, true);
        }
        let drops: [f64; 8] = std::array::from_fn(|at| drop(surface, cell, at as u8 + 1));
        let mut best = (0.0, [steepest, 0]);
        for (straight, diagonal) in TRIANGLES {
            let (to_straight, to_diagonal) = (drops[straight as usize - 1], drops[diagonal as usize - 1]);
            let beyond = to_diagonal - to_straight;
            let found = if beyond > 0.0 && to_straight > beyond {
                (to_straight * to_straight + beyond * beyond, [straight, diagonal])
            } else if beyond > 0.0 {
                (0.5 * to_diagonal * to_diagonal.max(0.0), [diagonal, 0])
            } else {
                (to_straight * to_straight.max(0.0), [straight, 0])
            };
            if found.0 > best.0 {
                best = found;
            }
        }
        Self::on_slope(surface, cell, best.1)
    }

    /// Those of a cell for which `receivers` have been found.
    fn again(surface: &Surface, cell: usize, steepest: u8, receivers: u8) -> Self {
        let is_flat = steepest == OUTLET || {
            let next = surface.neighbour(cell, steepest);
            surface.is_sea(next) || surface.level[next] == surface.level[cell]
        };
        if is_flat {
            return Self { codes: [steepest, 0], aside: [0.0; 2], is_flat };
        }
        let code = |bits: u8| if bits == 0 { 0 } else { bits.trailing_zeros() as u8 + 1 };
        let [straight, diagonal] = [code(receivers & STRAIGHT), code(receivers & !STRAIGHT)];
        Self::on_slope(surface, cell, if straight == 0 { [diagonal, 0] } else { [straight, diagonal] })
    }

    /// Of a cell that is higher than these neighbours, the straight one first if there are two.
    fn on_slope(surface: &Surface, cell: usize, codes: [u8; 2]) -> Self {
        let [straight, diagonal] = codes;
        if diagonal == 0 {
            return Self { codes, aside: [0.0; 2], is_flat: false };
        }
        let [to_straight, to_diagonal] = codes.map(|code| drop(surface, cell, code));
        let beyond = to_diagonal - to_straight;
        let length = (to_straight * to_straight + beyond * beyond).sqrt();
        let side = if diagonal == straight + 1 { 1.0 } else { -1.0 };
        let aside = [side * beyond / length, -side * (to_straight - beyond) / length];
        Self { codes, aside, is_flat: false }
    }

    /// The neighbours to which the cell may drain, as bits.
    pub(super) fn receivers(&self) -> u8 {
        let bit = |code: u8| if code == 0 { 0 } else { 1 << (code - 1) };
        bit(self.codes[0]) | bit(self.codes[1])
    }

    /// The code that a path takes which arrives so far aside, and how far aside it leaves.
    fn taken(&self, aside: f64) -> (u8, f32) {
        let [first, second] = self.aside.map(|step| aside + step);
        if self.is_flat {
            (self.codes[0], 0.0)
        } else if self.codes[1] == 0 || first.abs() <= second.abs() {
            (self.codes[0], first as f32)
        } else {
            (self.codes[1], second as f32)
        }
    }
}

/// Fall to a neighbour; to those without data there is none.
fn drop(surface: &Surface, cell: usize, code: u8) -> f64 {
    let there = surface.level[surface.neighbour(cell, code)];
    if there == NO_DATA { f64::NEG_INFINITY } else { f64::from(surface.level[cell]) - f64::from(there) }
}

/// What leaves a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Path {
    /// Cells above, and the cell itself.
    cells: u32,
    /// How far the path of most of them is aside of its fall line, in cells; to the right of who goes down is positive.
    aside: f32,
}

impl Path {
    /// The code that a cell takes, and the path that leaves it, by the paths that arrive and the levels from which they come.
    pub(super) fn through(
        candidates: &Candidates,
        arriving: impl Iterator<Item = (Self, f32)>,
    ) -> (u8, Self) {
        let (mut cells, mut main) = (1_u32, (Self::default(), f32::NEG_INFINITY));
        for (path, level) in arriving {
            cells = cells.saturating_add(path.cells);
            let rank = |(path, level): (Self, f32)| (path.cells, level, -path.aside.abs());
            if rank((path, level)) > rank(main) {
                main = (path, level);
            } else if rank((path, level)) == rank(main) && path.aside != main.0.aside {
                // Two that mirror each other.
                main.0.aside = 0.0;
            }
        }
        let (code, aside) = candidates.taken(f64::from(main.0.aside));
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

/// Puts directions of least deviation in place of those of steepest descent; flat ground keeps its own.
pub(super) fn lead(surface: &Surface, descent: &mut Descent) {
    let codes = std::mem::take(&mut descent.codes);
    descent.codes = Walk::new(surface, &codes).codes();
}

/// Paths on their way down.
struct Walk<'a> {
    surface: &'a Surface,
    steepest: &'a [u8],
    /// The neighbours to which, and those from which, each cell may drain.
    receivers: Vec<u8>,
    donors: Vec<u8>,
}

/// What is found of each cell.
struct Found {
    codes: Vec<AtomicU8>,
    paths: Vec<AtomicU64>,
    waiting: Vec<AtomicU8>,
}

impl<'a> Walk<'a> {
    fn new(surface: &'a Surface, steepest: &'a [u8]) -> Self {
        let cells = || (0..steepest.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
        let of = |cell: usize| Candidates::of(surface, cell, steepest[cell]).receivers();
        let receivers: Vec<u8> = cells().map(of).collect();
        let donors = |cell: usize| donors(surface, &receivers, cell);
        Self { surface, steepest, donors: cells().map(donors).collect(), receivers }
    }

    fn codes(&self) -> Vec<u8> {
        let cells = || (0..self.steepest.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
        let found = Found {
            codes: cells().map(|_| AtomicU8::new(OUTLET)).collect(),
            paths: cells().map(|_| AtomicU64::new(0)).collect(),
            waiting: cells().map(|cell| AtomicU8::new(self.donors[cell].count_ones() as u8)).collect(),
        };
        let heads = cells().filter(|&cell| self.donors[cell] == 0);
        heads.for_each_init(Vec::new, |open, head| {
            open.push(head);
            while let Some(cell) = open.pop() {
                self.pass(cell, &found, open);
            }
        });
        found.codes.into_par_iter().with_min_len(CELLS_PER_TASK).map(AtomicU8::into_inner).collect()
    }

    /// Finishes a cell, and finds those for which it was the last to wait for.
    fn pass(&self, cell: usize, found: &Found, open: &mut Vec<usize>) {
        let beside = |direction: usize| self.surface.neighbour(cell, direction as u8 + 1);
        let arriving = set_directions(self.donors[cell]).filter_map(|direction| {
            let donor = beside(direction);
            let comes = found.codes[donor].load(Ordering::Relaxed) == opposite(direction as u8) + 1;
            let path = Path::from_bits(found.paths[donor].load(Ordering::Relaxed));
            comes.then_some((path, self.surface.level[donor]))
        });
        let candidates = Candidates::again(self.surface, cell, self.steepest[cell], self.receivers[cell]);
        let (code, path) = Path::through(&candidates, arriving);
        found.codes[cell].store(code, Ordering::Relaxed);
        found.paths[cell].store(path.bits(), Ordering::Relaxed);
        for direction in set_directions(self.receivers[cell]) {
            // The counter hands the paths of those who came before over to the last.
            if found.waiting[beside(direction)].fetch_sub(1, Ordering::AcqRel) == 1 {
                open.push(beside(direction));
            }
        }
    }
}

/// The neighbours that may drain to a cell, as bits.
pub(super) fn donors(surface: &Surface, receivers: &[u8], cell: usize) -> u8 {
    if !surface.has_data(cell) {
        return 0;
    }
    let gives =
        |&direction: &u8| receivers[surface.neighbour(cell, direction + 1)] >> opposite(direction) & 1 == 1;
    (0..8).filter(gives).fold(0, |bits, direction| bits | 1 << direction)
}
