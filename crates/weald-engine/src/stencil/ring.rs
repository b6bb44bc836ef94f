//! Rows in flight: a short memory of the latest rows of one plane, and a row of zeros beyond the edge.
//!
//! Builds with debug assertions know which row each slot of a ring holds: a row that is not there cannot be
//! read, and what is there before a row is written is NaN. Release builds pay nothing for it.

mod watch;

use watch::Watch;

/// Values of one cache line.
pub const CACHE_LINE: usize = 16;

/// Cells before the first cell of a row, so that the western neighbour of column 0 exists and rows start on
/// a cache line: vectors that straddle two lines load at half the speed.
pub const MARGIN: usize = CACHE_LINE;

/// Position of the first value that begins a cache line. It says where to work fast, nothing else: a wrong
/// one would give the same results.
pub fn cache_line_start(values: &[f32]) -> usize {
    values.as_ptr().align_offset(CACHE_LINE * size_of::<f32>()).min(CACHE_LINE)
}

/// Length of a row in memory: margin, cells, an eastern neighbour, rounded up to whole cache lines.
pub fn segment(columns: usize) -> usize {
    MARGIN + (columns + 1).next_multiple_of(16)
}

/// The cells of a row.
#[inline]
pub fn here(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN..][..columns]
}

/// The cells of a row.
#[inline]
pub fn here_mut(row: &mut [f32], columns: usize) -> &mut [f32] {
    &mut row[MARGIN..][..columns]
}

/// The western neighbours of the cells of a row.
#[inline]
pub fn west(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN - 1..][..columns]
}

/// The eastern neighbours of the cells of a row.
#[inline]
pub fn east(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN + 1..][..columns]
}

/// The latest `depth` rows of one plane. Row `y` stays until row `y + depth` takes its place.
#[derive(Clone, Debug)]
pub struct Ring {
    cells: Vec<f32>,
    /// Where the first cache line of `cells` begins.
    start: usize,
    columns: usize,
    depth: usize,
    /// The row that was written last, and its slot: others are found from there, without a division a row.
    latest: usize,
    latest_slot: usize,
    watch: Watch,
}

impl Ring {
    /// A ring of so many rows, all zero.
    pub fn new(columns: usize, depth: usize) -> Self {
        let cells = vec![0.0_f32; segment(columns) * depth + CACHE_LINE];
        let start = cache_line_start(&cells);
        Self { cells, start, columns, depth, latest: 0, latest_slot: 0, watch: Watch::new(depth) }
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
            Some(back) if back < self.depth => self.latest_slot + self.depth - back,
            _ => y % self.depth,
        }
    }

    #[inline]
    fn cells_of(&self, slot: usize) -> std::ops::Range<usize> {
        let segment = segment(self.columns);
        let start = self.start + slot * segment;
        start..start + segment
    }

    #[inline]
    fn row(&self, y: usize) -> &[f32] {
        self.watch.read(y);
        &self.cells[self.cells_of(self.slot(y))]
    }

    /// Row `y`.
    #[inline]
    pub fn here(&self, y: usize) -> &[f32] {
        here(self.row(y), self.columns)
    }

    /// Western neighbours of row `y`.
    #[inline]
    pub fn west(&self, y: usize) -> &[f32] {
        west(self.row(y), self.columns)
    }

    /// Eastern neighbours of row `y`.
    #[inline]
    pub fn east(&self, y: usize) -> &[f32] {
        east(self.row(y), self.columns)
    }

    /// Row `y`, to write. It takes the place of row `y - depth`.
    #[inline]
    pub fn here_mut(&mut self, y: usize) -> &mut [f32] {
        let follows = y == self.latest + 1 && self.latest_slot + 1 < self.depth;
        self.latest_slot = if follows { self.latest_slot + 1 } else { self.slot(y) };
        self.latest = y;
        let cells = self.cells_of(self.latest_slot);
        let row = here_mut(&mut self.cells[cells], self.columns);
        self.watch.write(y, row);
        row
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
