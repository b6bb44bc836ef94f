//! Fall lines, and the neighbours on both sides of them to which D8-LTD may lead water.
//!
//! The fall line of a cell leads down the steepest of the eight triangles that it makes with its neighbours (Tarboton
//! 1997, doi 10.1029/96WR03137), between a straight neighbour 1 and a diagonal one 2. With the drops `s1` from the cell
//! to 1 and `s2` from 1 to 2, a step to one of them ends aside of the fall line by
//!
//! ```text
//! δ1 = s2 / √(s1² + s2²)      δ2 = -(s1 - s2) / √(s1² + s2²)      in cells, on two sides of it
//! ```
//!
//! Where the line leads outside all triangles it lies along an edge, and there is one neighbour. Whole rows are looked at
//! at once.

use rayon::prelude::*;

use super::surface::{ROWS_PER_TASK, Surface};
use crate::flow::directions::{OUTLET, STEPS, opposite};
use weald_core::vectors;

/// Codes of each straight neighbour and of the diagonal ones to the right and the left of who goes there.
const STRAIGHTS: [[u8; 3]; 4] = [[1, 2, 8], [3, 4, 2], [5, 6, 4], [7, 8, 6]];

/// Bits of the straight neighbours.
const STRAIGHT: u8 = 0b0101_0101;

/// How far a step lies aside to a neighbour that is none.
const NO_NEIGHBOUR: f32 = f32::INFINITY;

/// How far one lies aside where the ground tells of no fall line.
const NO_FALL_LINE: f32 = f32::NAN;

/// Of all cells of a surface, with the ring.
#[derive(Debug)]
pub(super) struct FallLines {
    /// The neighbours to which each may drain, as bits: a straight one, a diagonal one, or one of each.
    pub(super) receivers: Vec<u8>,
    /// How far a step to the straight one and to the diagonal one ends aside of the fall line, in cells; to the right of who
    /// goes down is positive. [`NO_NEIGHBOUR`] where one is none, [`NO_FALL_LINE`] on flat ground.
    aside: Vec<[f32; 2]>,
}

impl FallLines {
    /// Those of a surface whose cells drain by such codes in D8, over flat ground too.
    pub(super) fn of(surface: &Surface, steepest: &[u8]) -> Self {
        let (stride, columns) = (surface.stride, surface.size.columns);
        let mut lines = Self { receivers: vec![0; surface.cells()], aside: vec![[0.0; 2]; surface.cells()] };
        let rows = lines.receivers.par_chunks_mut(stride).zip(lines.aside.par_chunks_mut(stride));
        rows.enumerate().skip(1).take(surface.size.rows).with_min_len(ROWS_PER_TASK).for_each_init(
            || Row::new(columns),
            |row, (y, (receivers, aside))| {
                row.compare([y - 1, y, y + 1].map(|y| &surface.level[y * stride..][..stride]));
                let steepest = &steepest[y * stride + 1..][..columns];
                let cells = receivers[1..].iter_mut().zip(&mut aside[1..]).zip(steepest).enumerate();
                for (x, ((receivers, aside), &steepest)) in cells {
                    (*receivers, *aside) = row.found(x, steepest);
                }
            },
        );
        lines
    }

    /// The neighbours that may drain to each cell, as bits.
    pub(super) fn donors(&self, surface: &Surface) -> Vec<u8> {
        let (stride, columns) = (surface.stride, surface.size.columns);
        let mut donors = vec![0; self.receivers.len()];
        let rows = donors.par_chunks_mut(stride).enumerate().skip(1).take(surface.size.rows);
        rows.with_min_len(ROWS_PER_TASK).for_each(|(y, donors)| {
            let donors = &mut donors[1..=columns];
            vectors::widest(
                #[inline(always)]
                || {
                    for (direction, (east, south)) in (0..8).zip(STEPS) {
                        let first = ((y * stride + 1) as isize + south * stride as isize + east) as usize;
                        let there = &self.receivers[first..][..columns];
                        for (donors, &there) in donors.iter_mut().zip(there) {
                            *donors |= (there >> opposite(direction) & 1) << direction;
                        }
                    }
                },
            );
        });
        donors
    }

    /// The code that a path takes which arrives so far aside, and how far aside it leaves.
    #[inline]
    pub(super) fn taken(&self, cell: usize, aside: f32) -> (u8, f32) {
        let receivers = self.receivers[cell];
        let [first, second] = self.aside[cell].map(|step| aside + step);
        let is_straight = first.abs() <= second.abs() || first.is_nan();
        let (bits, leaves) =
            if is_straight { (receivers & STRAIGHT, first) } else { (receivers & !STRAIGHT, second) };
        let code = if bits == 0 { OUTLET } else { bits.trailing_zeros() as u8 + 1 };
        (code, if leaves.is_nan() { 0.0 } else { leaves })
    }
}

/// What is known of a row while its neighbours are looked at. Kinds are floats, so that all lanes are alike.
struct Row {
    /// Of the steepest fall line, the square.
    steepness: Vec<f32>,
    /// Its place in [`RECEIVERS`].
    kind: Vec<f32>,
    /// The drops `s1` and `s2` beside it.
    drops: [Vec<f32>; 2],
    aside: Vec<[f32; 2]>,
}

/// Fall lines beside a straight neighbour: along the edge to it, along those to the diagonal ones, and within the triangles.
const KINDS: usize = 5;

/// The bits of the receivers by number of the straight neighbour and kind, and on which side of the fall line that lies where
/// there are two.
const RECEIVERS: [(u8, f32); KINDS * STRAIGHTS.len()] = {
    let mut receivers = [(0, 0.0); KINDS * STRAIGHTS.len()];
    let mut number = 0;
    while number < STRAIGHTS.len() {
        let [straight, right, left] = STRAIGHTS[number];
        let [straight, right, left] = [1 << (straight - 1), 1 << (right - 1), 1 << (left - 1)];
        let kinds =
            [(straight, 0.0), (right, 0.0), (left, 0.0), (straight | right, 1.0), (straight | left, -1.0)];
        let mut kind = 0;
        while kind < KINDS {
            receivers[KINDS * number + kind] = kinds[kind];
            kind += 1;
        }
        number += 1;
    }
    receivers
};

impl Row {
    fn new(columns: usize) -> Self {
        let empty = || vec![0.0; columns];
        Self { steepness: empty(), kind: empty(), drops: [empty(), empty()], aside: vec![[0.0; 2]; columns] }
    }

    fn compare(&mut self, rows: [&[f32]; 3]) {
        self.steepness.fill(0.0);
        vectors::widest(
            #[inline(always)]
            || {
                for (number, codes) in STRAIGHTS.into_iter().enumerate() {
                    let beside = codes.map(|code| {
                        let (east, south) = STEPS[usize::from(code) - 1];
                        &rows[(1 + south) as usize][(1 + east) as usize..]
                    });
                    self.look((KINDS * number) as f32, &rows[1][1..], beside);
                }
                self.measure();
            },
        );
    }

    /// Looks at both triangles beside a straight neighbour, of which that with the lower diagonal one is the steeper.
    #[inline(always)]
    fn look(&mut self, first_kind: f32, here: &[f32], [straight, right, left]: [&[f32]; 3]) {
        let [first, second] = &mut self.drops;
        let best = self.steepness.iter_mut().zip(&mut self.kind).zip(first.iter_mut().zip(second));
        let levels = here.iter().zip(straight).zip(right.iter().zip(left));
        for (((best, best_kind), (first, second)), ((&here, &straight), (&right, &left))) in best.zip(levels)
        {
            let is_right = right <= left;
            let side = if is_right { 0.0 } else { 1.0 };
            let diagonal = if is_right { right } else { left };
            // To those without data there is no drop: their level is infinite.
            let (to_straight, to_diagonal) = (here - straight, here - diagonal);
            let beyond = straight - diagonal;
            let between = to_straight * to_straight + beyond * beyond;
            let along_diagonal = 0.5 * to_diagonal * to_diagonal.max(0.0);
            let along_straight = to_straight * to_straight.max(0.0);
            let is_within = to_straight > beyond;
            let falling_on = if is_within { between } else { along_diagonal };
            let kind_falling_on = if is_within { 3.0 + side } else { 1.0 + side };
            let falls_on = beyond > 0.0;
            let found = if falls_on { falling_on } else { along_straight };
            let kind = first_kind + if falls_on { kind_falling_on } else { 0.0 };
            let better = found > *best;
            *best = if better { found } else { *best };
            *best_kind = if better { kind } else { *best_kind };
            *first = if better { to_straight } else { *first };
            *second = if better { beyond } else { *second };
        }
    }

    /// How far the two steps beside each fall line end aside of it.
    #[inline(always)]
    fn measure(&mut self) {
        let [first, second] = &self.drops;
        for (aside, (&first, &second)) in self.aside.iter_mut().zip(first.iter().zip(second)) {
            let length = (first * first + second * second).sqrt();
            *aside = [second / length, (first - second) / length];
        }
    }

    /// The receivers of a cell that drains by that code in D8, and how far steps to them lie aside.
    fn found(&self, x: usize, steepest: u8) -> (u8, [f32; 2]) {
        if steepest == OUTLET {
            return (0, [NO_FALL_LINE, NO_NEIGHBOUR]);
        }
        // Flat ground has no drop, the sea an infinite one.
        let steepness = self.steepness[x];
        let alone = |receivers: u8, aside: f32| {
            (receivers, if receivers & STRAIGHT == 0 { [NO_NEIGHBOUR, aside] } else { [aside, NO_NEIGHBOUR] })
        };
        if steepness <= 0.0 || steepness.is_infinite() {
            return alone(1 << (steepest - 1), NO_FALL_LINE);
        }
        let (receivers, side) = RECEIVERS[self.kind[x] as usize];
        let [straight, diagonal] = self.aside[x];
        if side == 0.0 { alone(receivers, 0.0) } else { (receivers, [side * straight, -side * diagonal]) }
    }
}
