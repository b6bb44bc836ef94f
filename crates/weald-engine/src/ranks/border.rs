//! Rows that a rank gives its neighbours, and those that it gets from them.

use std::ops::Range;

use super::messages::Swap;
use super::share::Share;
use weald_core::error::Error;

/// What goes to the north and the south, and what comes from there.
pub(super) struct Border {
    share: Share,
    columns: usize,
    planes: usize,
    given: [Vec<f32>; 2],
    taken: [Vec<f32>; 2],
}

/// A neighbour.
struct Side {
    with: usize,
    /// Rows that it gets, and those that come from it, counted from the first that are held.
    ours: Range<usize>,
    theirs: Range<usize>,
}

impl Border {
    /// That of a share, for the first so many planes of rows of so many columns.
    pub(super) fn new(share: Share, (columns, planes): (usize, usize)) -> Self {
        Self { share, columns, planes, given: Default::default(), taken: Default::default() }
    }

    /// The neighbours, north and south, with so many rows on either side.
    fn sides(&self, halo: usize) -> [Option<Side>; 2] {
        let (own, first) = (self.share.own(), self.share.held().start);
        let (start, end) = (own.start - first, own.end - first);
        [
            self.share.north().map(|with| Side {
                with,
                ours: start..start + halo,
                theirs: start - halo..start,
            }),
            self.share.south().map(|with| Side { with, ours: end - halo..end, theirs: end..end + halo }),
        ]
    }

    /// Copies what neighbours get of so many rows.
    pub(super) fn give<'a>(&mut self, halo: usize, row: impl Fn(usize, usize) -> &'a [f32]) {
        let sides = self.sides(halo);
        for (side, give) in sides.iter().zip(&mut self.given) {
            give.clear();
            let rows = side.as_ref().map_or(0..0, |side| side.ours.clone());
            for y in rows {
                (0..self.planes).for_each(|plane| give.extend_from_slice(row(y, plane)));
            }
        }
    }

    /// Swaps it for what they give, by a function that waits until all has come.
    pub(super) fn swap(
        &mut self,
        halo: usize,
        swap: impl FnOnce(&mut [Swap<'_>]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let sides = self.sides(halo);
        let length = halo * self.planes * self.columns;
        let buffers = self.given.iter().zip(&mut self.taken);
        let mut swaps: Vec<_> = sides
            .iter()
            .zip(buffers)
            .filter_map(|(side, (give, take))| {
                let with = side.as_ref()?.with;
                take.resize(length, 0.0);
                Some(Swap { with, give, take })
            })
            .collect();
        if swaps.is_empty() { Ok(()) } else { swap(&mut swaps) }
    }

    /// Goes over all rows of others that are held, a row of a plane at a time.
    pub(super) fn spoil(&self, mut spoil: impl FnMut(usize, usize)) {
        let (own, held) = (self.share.own(), self.share.held());
        for y in (held.start..own.start).chain(own.end..held.end) {
            (0..self.planes).for_each(|plane| spoil(y - held.start, plane));
        }
    }

    /// Puts what has come, a row of a plane at a time.
    pub(super) fn take(&self, halo: usize, mut put: impl FnMut(usize, usize, &[f32])) {
        for (side, take) in self.sides(halo).iter().zip(&self.taken) {
            let rows = side.as_ref().map_or(0..0, |side| side.theirs.clone());
            let places = rows.flat_map(|y| (0..self.planes).map(move |plane| (y, plane)));
            for ((y, plane), cells) in places.zip(take.chunks_exact(self.columns)) {
                put(y, plane, cells);
            }
        }
    }
}
