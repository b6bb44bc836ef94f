//! Sums of what flows to each cell where flow divides, each cell once all above it are known.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

use rayon::prelude::*;

use super::accumulate::{CellWeights, set_directions};
use super::multiple::{MultipleFlow, weigh, weight};
use super::row_weights::RowWeights;
use crate::flow::directions::{CELLS_PER_TASK, STEPS, opposite};
use weald_core::grid::{Field, Size};
use weald_core::vectors;

/// The sum of the weights of each cell and its share of all above it; see
/// [`accumulate`](super::accumulate()).
///
/// # Panics
/// If the weights or the mask are of another size than the surface: a bug of the caller.
pub fn accumulate_multiple(flow: &MultipleFlow<'_>, weight: Option<&Field>) -> Vec<f64> {
    let cells = flow.routed.surface.size().cells();
    let own = CellWeights::new(cells, flow.valid, weight);
    let shares = Shares::of(flow);
    let donors: Vec<u8> =
        (0..cells).into_par_iter().with_min_len(CELLS_PER_TASK).map(|cell| shares.donors(cell)).collect();
    let spread = Spread { shares, own, donors };
    spread.sums()
}

/// What each cell gives to its neighbours.
pub(super) struct Shares<'a> {
    flow: &'a MultipleFlow<'a>,
    /// The ways by which each cell gives, as bits.
    pub(super) receivers: Vec<u8>,
    totals: Vec<f64>,
}

impl<'a> Shares<'a> {
    pub(super) fn of(flow: &'a MultipleFlow<'a>) -> Self {
        let Size { columns, rows } = flow.routed.surface.size();
        let (mut receivers, mut totals) = (vec![0; columns * rows], vec![0.0; columns * rows]);
        let by_rows = receivers.par_chunks_mut(columns).zip(totals.par_chunks_mut(columns));
        by_rows.enumerate().for_each(|(y, (receivers, totals))| {
            if let Some(weights) = RowWeights::of(flow, y) {
                receivers[1..columns - 1].copy_from_slice(&weights.receivers());
                totals[1..columns - 1].copy_from_slice(weights.totals());
            }
            for x in 0..columns {
                // Outlets give nothing, though there may be lower ground in a sea; flat ground gives by its direction.
                let cell = y * columns + x;
                if totals[x] == 0.0 || flow.routed.directions.downstream(cell).is_none() {
                    (receivers[x], totals[x]) = links(flow, cell);
                }
            }
        });
        Self { flow, receivers, totals }
    }

    /// The ways from which a cell gets something, as bits.
    fn donors(&self, cell: usize) -> u8 {
        let gives = |direction: &u8| {
            let other = self.flow.neighbour(cell, usize::from(*direction));
            other.is_some_and(|other| self.receivers[other] >> opposite(*direction) & 1 == 1)
        };
        (0..8).filter(gives).fold(0, |bits, direction| bits | 1 << direction)
    }

    /// The share that a cell gives to the one it lies beside, as seen from there.
    pub(super) fn share(&self, giver: usize, cell: usize, direction: usize) -> f64 {
        self.share_of(giver, || weight(self.flow.descent(giver, cell, direction), self.flow.exponent))
    }

    /// The same by the weight of that neighbour, which one that gives to no other has whole.
    fn share_of(&self, giver: usize, weight: impl Fn() -> f64) -> f64 {
        if self.receivers[giver].is_power_of_two() { 1.0 } else { weight() / self.totals[giver] }
    }
}

/// The ways by which a cell gives, and the sum of their weights.
#[inline(always)]
fn links(flow: &MultipleFlow<'_>, cell: usize) -> (u8, f64) {
    let weights = flow.weights(cell);
    let bit = |(direction, &weight): (usize, &f64)| u8::from(weight > 0.0) << direction;
    (weights.iter().enumerate().map(bit).fold(0, |bits, bit| bits | bit), weights.iter().sum())
}

/// Water on its way.
struct Spread<'a> {
    shares: Shares<'a>,
    own: CellWeights<'a>,
    donors: Vec<u8>,
}

impl Spread<'_> {
    fn sums(&self) -> Vec<f64> {
        let cells = self.donors.len();
        let sums: Vec<AtomicU64> = (0..cells).into_par_iter().map(|_| AtomicU64::new(0)).collect();
        let waiting: Vec<AtomicU8> =
            self.donors.par_iter().map(|donors| AtomicU8::new(donors.count_ones() as u8)).collect();
        let heads =
            (0..cells).into_par_iter().with_min_len(CELLS_PER_TASK).filter(|&cell| self.donors[cell] == 0);
        heads.for_each_init(Vec::new, |open, head| {
            open.push(head);
            while let Some(cell) = open.pop() {
                self.pass(cell, &sums, &waiting, open);
            }
        });
        sums.into_par_iter().map(|sum| f64::from_bits(sum.into_inner())).collect()
    }

    /// Finishes a cell, and finds those for which it was the last to wait for.
    fn pass(&self, cell: usize, sums: &[AtomicU64], waiting: &[AtomicU8], open: &mut Vec<usize>) {
        let received = self.received(cell, sums);
        sums[cell].store((self.own.at(cell) + received).to_bits(), Ordering::Relaxed);
        for direction in set_directions(self.shares.receivers[cell]) {
            let next = self.beside(cell, direction);
            // The counter hands the sums of those who came before over to the last.
            if waiting[next].fetch_sub(1, Ordering::AcqRel) == 1 {
                open.push(next);
            }
        }
    }

    /// What comes to a cell from all that give to it, whose sums are known.
    fn received(&self, cell: usize, sums: &[AtomicU64]) -> f64 {
        let (flow, mut weights) = (self.shares.flow, [0.0; 8]);
        for direction in set_directions(self.donors[cell]) {
            weights[direction] = flow.descent(self.beside(cell, direction), cell, direction);
        }
        vectors::widest(
            #[inline(always)]
            || weigh(&mut weights, flow.exponent),
        );
        let of_giver = |direction: usize| {
            let giver = self.beside(cell, direction);
            let sum = f64::from_bits(sums[giver].load(Ordering::Relaxed));
            sum * self.shares.share_of(giver, || weights[direction])
        };
        set_directions(self.donors[cell]).map(of_giver).sum()
    }

    fn beside(&self, cell: usize, direction: usize) -> usize {
        let (east, south) = STEPS[direction];
        cell.wrapping_add_signed(south * self.shares.flow.routed.surface.size().columns as isize + east)
    }
}
