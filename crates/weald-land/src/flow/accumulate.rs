//! Upslope sums along D8 directions: what passes a cell is its own weight and all that its donors pass.
//!
//! Threads walk down from the heads. Where paths meet, the last to arrive goes on, and adds what came by each in
//! the order of directions: no sum depends on who came first.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

use rayon::prelude::*;

use crate::flow::directions::{CELLS_PER_TASK, Directions, STEPS};
use weald_core::grid::{Field, Mask};

/// The sum of the weights of each cell and all above it; each cell weighs 1 without weights, and nothing where
/// it has no data. What arrives at the outlets and in the sea is what all cells weigh.
///
/// # Panics
/// If the weights or the mask are of another size than the directions: a bug of the caller.
pub fn accumulate(directions: &Directions, valid: Option<&Mask>, weight: Option<&Field>) -> Vec<f64> {
    let cells = directions.size().cells();
    let walk = Walk { directions, own: CellWeights::new(cells, valid, weight), donors: directions.donors() };
    let sums: Vec<AtomicU64> = (0..cells).into_par_iter().map(|_| AtomicU64::new(0)).collect();
    let waiting: Vec<AtomicU8> =
        walk.donors.par_iter().map(|donors| AtomicU8::new(donors.count_ones() as u8)).collect();
    let heads =
        (0..cells).into_par_iter().with_min_len(CELLS_PER_TASK).filter(|&cell| walk.donors[cell] == 0);
    heads.for_each(|head| walk.down_from(head, &sums, &waiting));
    sums.into_par_iter().with_min_len(CELLS_PER_TASK).map(|sum| f64::from_bits(sum.into_inner())).collect()
}

/// What each cell adds by itself.
pub(super) struct CellWeights<'a> {
    valid: Option<&'a Mask>,
    weight: Option<&'a Field>,
}

impl<'a> CellWeights<'a> {
    pub(super) fn new(cells: usize, valid: Option<&'a Mask>, weight: Option<&'a Field>) -> Self {
        assert!(
            valid.is_none_or(|valid| valid.size().cells() == cells),
            "the mask has the size of the directions"
        );
        assert!(weight.is_none_or(|w| w.values().len() == cells), "weights have the size of the directions");
        Self { valid, weight }
    }

    pub(super) fn at(&self, cell: usize) -> f64 {
        if self.valid.is_some_and(|valid| !valid.is_valid_at(cell)) {
            return 0.0;
        }
        self.weight.map_or(1.0, |weight| f64::from(weight.values()[cell]))
    }
}

/// The ways, 0 to 7, whose bits are set.
pub(super) fn set_directions(mut bits: u8) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let direction = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (direction < 8).then_some(direction)
    })
}

struct Walk<'a> {
    directions: &'a Directions,
    own: CellWeights<'a>,
    donors: Vec<u8>,
}

impl Walk<'_> {
    fn down_from(&self, head: usize, sums: &[AtomicU64], waiting: &[AtomicU8]) {
        let mut cell = head;
        loop {
            let sum = self.own.at(cell) + self.received(cell, sums);
            sums[cell].store(sum.to_bits(), Ordering::Relaxed);
            let Some(next) = self.directions.downstream(cell) else { return };
            // The counter hands the sums of those who came before over to the last.
            let alone = self.donors[next].is_power_of_two();
            if !alone && waiting[next].fetch_sub(1, Ordering::AcqRel) != 1 {
                return;
            }
            cell = next;
        }
    }

    fn received(&self, cell: usize, sums: &[AtomicU64]) -> f64 {
        let columns = self.directions.size().columns as isize;
        let from = set_directions(self.donors[cell]).map(|direction| {
            let (east, south) = STEPS[direction];
            f64::from_bits(sums[cell.wrapping_add_signed(south * columns + east)].load(Ordering::Relaxed))
        });
        from.sum()
    }
}
