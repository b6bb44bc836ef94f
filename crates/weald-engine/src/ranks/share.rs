//! How the rows of a simulation in lockstep are shared among ranks.

use std::ops::Range;

use super::shared_rows::SharedRows;

/// Rows of one rank, and those that it needs around them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Share {
    rows: SharedRows,
    /// Rows that a cell feels in one step.
    reach: usize,
    /// Most steps between two exchanges.
    pub(super) block: usize,
}

/// Rows beyond the reach that means take values from.
const SOUTH_OF_MEANS: usize = 1;

impl Share {
    /// The share of one of `count` ranks. Each that has rows has so many that what it feels lies with its neighbours; on
    /// grids that are too low for that, the last ranks have none.
    pub(super) fn of(rank_and_count: (usize, usize), rows: usize, reach: usize) -> Self {
        let rows = SharedRows::among(rank_and_count, rows, reach + SOUTH_OF_MEANS);
        // More steps at a time exchange less often and compute more rows twice.
        let block = (rows.least() / (4 * reach)).clamp(1, 4);
        Self { rows, reach, block }
    }

    /// The same for another rank.
    pub(super) fn of_rank(&self, rank: usize) -> Self {
        Self { rows: self.rows.of_rank(rank), ..self.clone() }
    }

    /// Its own rows.
    pub(super) fn own(&self) -> Range<usize> {
        self.rows.own()
    }

    /// Its own rows with those around them.
    pub(super) fn held(&self) -> Range<usize> {
        let (own, halo) = (self.own(), self.halo(self.block));
        if own.is_empty() {
            return own;
        }
        own.start.saturating_sub(halo)..(own.end + halo).min(self.rows.count())
    }

    /// Rows around its own that it needs for so many steps.
    pub(super) fn halo(&self, steps: usize) -> usize {
        self.reach * steps + SOUTH_OF_MEANS
    }

    /// Rows at the northern and the southern end of those that it holds that feel those of a neighbour in the steps of a block.
    pub(super) fn edges(&self) -> [usize; 2] {
        let (own, held, halo) = (self.own(), self.held(), self.halo(self.block));
        let edge = |neighbour: Option<usize>, theirs: usize| neighbour.map_or(0, |_| theirs + halo);
        [edge(self.north(), own.start - held.start), edge(self.south(), held.end - own.end)]
    }

    /// The rank that has the rows to the north.
    pub(super) fn north(&self) -> Option<usize> {
        self.rows.north()
    }

    /// The rank that has the rows to the south.
    pub(super) fn south(&self) -> Option<usize> {
        self.rows.south()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_have_all_rows_once_and_need_none_beyond_their_neighbours() {
        for (rows, count, reach) in [(1, 4, 3), (7, 2, 6), (40, 6, 5), (41, 3, 2), (500, 6, 9), (64, 64, 1)] {
            let whole = Share::of((0, count), rows, reach);
            let shares: Vec<_> = (0..count).map(|rank| whole.of_rank(rank)).collect();
            let owned: Vec<_> = shares.iter().flat_map(Share::own).collect();
            assert_eq!(owned, (0..rows).collect::<Vec<_>>(), "{whole:?}");
            for share in shares.iter().filter(|share| !share.own().is_empty()) {
                let (own, held) = (share.own(), share.held());
                assert!(held.start <= own.start && own.end <= held.end);
                let first = share.north().map_or(0, |north| share.of_rank(north).own().start);
                let end = share.south().map_or(rows, |south| share.of_rank(south).own().end);
                assert!(first <= held.start && held.end <= end, "{share:?} holds {held:?}");
                let [north, south] = share.edges();
                let inside = held.start + north..held.end - south;
                let felt = |neighbour: Option<usize>| neighbour.map_or(0, |_| reach * share.block);
                assert!(own.start + felt(share.north()) <= inside.start, "{share:?}: {inside:?}");
                assert!(inside.end + felt(share.south()) <= own.end, "{share:?}: {inside:?}");
                assert_eq!(
                    (own.start == 0, own.end == rows),
                    (share.north().is_none(), share.south().is_none())
                );
            }
        }
    }
}
