//! Rows in flight: a short memory of the latest rows of one plane, and a row of zeros beyond the edge.
//!
//! Builds with debug assertions know which row each slot of a ring holds: a row that is not there cannot be
//! read, and what is there before a row is written is NaN. Release builds pay nothing for it.

mod watch;

use super::segment::Segment;
use watch::Watch;

/// The latest `depth` rows of one plane. Row `y` stays until row `y + depth` takes its place.
#[derive(Clone, Debug)]
pub struct Ring {
    rows: Vec<Segment>,
    /// The row that was written last, and its slot: others are found from there, without a division a row.
    latest: usize,
    latest_slot: usize,
    watch: Watch,
}

impl Ring {
    /// A ring of so many rows, all zero.
    pub fn new(columns: usize, depth: usize) -> Self {
        let rows = (0..depth).map(|_| Segment::new(columns)).collect();
        Self { rows, latest: 0, latest_slot: 0, watch: Watch::new(depth) }
    }

    /// Rows that it holds.
    pub fn depth(&self) -> usize {
        self.rows.len()
    }

    /// The row beyond a wall, number 0 of a ring that nothing is written to: all of its cells are 0.
    pub fn still(columns: usize) -> Self {
        let mut ring = Self::new(columns, 1);
        ring.here_mut(0).fill(0.0);
        ring
    }

    /// The slot of row `y`, which is that of `y % depth`.
    #[inline]
    fn slot(&self, y: usize) -> usize {
        match self.latest.checked_sub(y) {
            Some(back) if back <= self.latest_slot => self.latest_slot - back,
            Some(back) if back < self.depth() => self.latest_slot + self.depth() - back,
            _ => y % self.depth(),
        }
    }

    #[inline]
    fn row(&self, y: usize) -> &Segment {
        self.watch.read(y);
        &self.rows[self.slot(y)]
    }

    /// Row `y`.
    #[inline]
    pub fn here(&self, y: usize) -> &[f32] {
        self.row(y).here()
    }

    /// Western neighbours of row `y`.
    #[inline]
    pub fn west(&self, y: usize) -> &[f32] {
        self.row(y).west()
    }

    /// Eastern neighbours of row `y`.
    #[inline]
    pub fn east(&self, y: usize) -> &[f32] {
        self.row(y).east()
    }

    /// The slot that row `y` takes as the newest one.
    #[inline]
    fn newest(&mut self, y: usize) -> usize {
        let follows = y == self.latest + 1 && self.latest_slot + 1 < self.depth();
        self.latest_slot = if follows { self.latest_slot + 1 } else { self.slot(y) };
        self.latest = y;
        self.latest_slot
    }

    /// Row `y`, to write. It takes the place of row `y - depth`.
    #[inline]
    pub fn here_mut(&mut self, y: usize) -> &mut [f32] {
        let slot = self.newest(y);
        let row = self.rows[slot].here_mut();
        self.watch.write(y, row);
        row
    }

    /// Takes in row `y`, as long as the others, which takes the place of row `y - depth`; gives that one's memory for it.
    pub fn take_in(&mut self, y: usize, row: &mut Segment) {
        let slot = self.newest(y);
        std::mem::swap(&mut self.rows[slot], row);
        self.watch.hold(y);
    }

    /// Gives row `y`, which it then has no longer, to another ring.
    pub fn hand_over(&mut self, y: usize, to: &mut Self) {
        self.watch.read(y);
        let slot = self.slot(y);
        to.take_in(y, &mut self.rows[slot]);
        self.watch.forget(y);
    }

    /// Gives out row `y`, which it then has no longer, for other memory.
    pub fn give_out(&mut self, y: usize, row: &mut Segment) {
        self.watch.read(y);
        let slot = self.slot(y);
        std::mem::swap(&mut self.rows[slot], row);
        self.watch.forget(y);
    }
}

#[cfg(all(test, debug_assertions))]
mod tests {
    use super::*;

    #[test]
    fn a_new_row_is_no_number_until_it_is_written_and_the_margins_are_zeros() {
        let mut ring = Ring::new(3, 2);
        ring.here_mut(5).copy_from_slice(&[1.0, 2.0, 3.0]);
        assert_eq!((ring.west(5), ring.east(5)), (&[0.0, 1.0, 2.0][..], &[2.0, 3.0, 0.0][..]));
        assert!(ring.here_mut(7).iter().all(|cell| cell.is_nan()), "row 5 is gone");
        assert_eq!(Ring::still(3).here(0), [0.0; 3]);
    }

    #[test]
    #[should_panic(expected = "row 4 is read where row 6 lies")]
    fn a_row_that_gave_way_to_a_later_one_cannot_be_read() {
        let mut ring = Ring::new(3, 2);
        for y in 4..7 {
            ring.here_mut(y).fill(0.0);
        }
        ring.here(4);
    }

    #[test]
    #[should_panic(expected = "row 4 is read before it is written")]
    fn a_row_that_was_never_written_cannot_be_read() {
        Ring::new(3, 2).here(4);
    }
}
