//! How the rows of a grid are shared among ranks.

use std::ops::Range;

/// Fewest rows of a rank that has any, so that what its neighbours need around theirs lies with it alone.
const LEAST: usize = 32;

/// Rows of a grid, of which each rank has a run, from north to south by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharedRows {
    rank: usize,
    /// Ranks that have rows; those behind them have none.
    active: usize,
    rows: usize,
    /// Rows more at the northern and at the southern end.
    ring: usize,
}

impl SharedRows {
    /// The rows of one of `count` ranks. Of a grid that is too low for that many, the last ranks have none.
    pub fn of((rank, count): (usize, usize), rows: usize) -> Self {
        Self::among((rank, count), rows, LEAST)
    }

    /// The same where each that has rows has no fewer than so many.
    pub(super) fn among((rank, count): (usize, usize), rows: usize, least: usize) -> Self {
        let active = count.clamp(1, (rows / least).max(1));
        Self { rank, active, rows, ring: 0 }
    }

    /// The same for another rank.
    #[must_use]
    pub fn of_rank(&self, rank: usize) -> Self {
        Self { rank, ..self.clone() }
    }

    /// The same rows with so many more at the northern and at the southern end, which the first and the last rank have.
    #[must_use]
    pub fn ringed(&self, ring: usize) -> Self {
        Self { ring: self.ring + ring, ..self.clone() }
    }

    /// Rows of the whole.
    pub fn count(&self) -> usize {
        self.rows + 2 * self.ring
    }

    /// Its own rows.
    pub fn own(&self) -> Range<usize> {
        self.start(self.rank)..self.start(self.rank + 1)
    }

    fn start(&self, rank: usize) -> usize {
        match rank {
            0 => 0,
            rank if rank >= self.active => self.count(),
            rank => self.rows * rank / self.active + self.ring,
        }
    }

    /// Fewest rows of a rank that has any.
    pub fn least(&self) -> usize {
        self.rows / self.active
    }

    /// Most rows of a rank.
    pub fn most(&self) -> usize {
        (self.rows.div_ceil(self.active) + 2 * self.ring).min(self.count())
    }

    /// Whether one rank has them all.
    pub fn is_whole(&self) -> bool {
        self.active == 1
    }

    /// The rank that has the rows to the north.
    pub fn north(&self) -> Option<usize> {
        self.rank.checked_sub(1).filter(|_| self.rank < self.active)
    }

    /// The rank that has the rows to the south.
    pub fn south(&self) -> Option<usize> {
        Some(self.rank + 1).filter(|rank| *rank < self.active)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_have_all_rows_once_with_the_ring_at_the_ends() {
        for (rows, count, ring) in [(1, 4, 1), (31, 2, 0), (290, 6, 1), (64, 2, 2), (500, 6, 0)] {
            let whole = SharedRows::of((0, count), rows).ringed(ring);
            let shares: Vec<_> = (0..count).map(|rank| whole.of_rank(rank)).collect();
            let owned: Vec<_> = shares.iter().flat_map(SharedRows::own).collect();
            assert_eq!(owned, (0..rows + 2 * ring).collect::<Vec<_>>(), "{whole:?}");
            let inner = SharedRows::of((0, count), rows);
            for share in shares.iter().filter(|share| !share.own().is_empty()) {
                assert!((share.least()..=share.most()).contains(&share.own().len()), "{share:?}");
                assert!(share.is_whole() || share.least() >= LEAST);
                let [own, with_ring] = [inner.of_rank(share.rank).own(), share.own()];
                assert!(with_ring.start <= own.start + ring && own.end + ring <= with_ring.end);
                assert_eq!(share.north().is_none(), with_ring.start == 0);
                assert_eq!(share.south().is_none(), with_ring.end == share.count());
            }
        }
    }
}
