//! Strips of rows of a plane whose rows lie with ranks: files hold some rows in common, and one rank alone may write each.
//!
//! A strip belongs to the rank that has its first row, which gets the others from the ranks to the south.

use std::ops::Range;

use crate::ranks::{Ranks, Reader, SharedRows, Writer, agreed};
use crate::stored_plane::StoredPlane;
use weald_core::error::Error;

/// The strips of this rank, of which it can read all rows.
#[derive(Debug)]
pub struct Strips<'a> {
    plane: &'a StoredPlane,
    height: usize,
    /// Rows of its last strip that lie with other ranks.
    south: Vec<f32>,
}

impl<'a> Strips<'a> {
    /// Strips of so many rows from each multiple of that on, the last up to the end. All ranks call it together.
    ///
    /// # Errors
    /// Those of the disk on any rank; [`Error::Run`] where another can no longer be reached.
    pub fn of(plane: &'a StoredPlane, height: usize, ranks: &dyn Ranks) -> Result<Self, Error> {
        let shared = plane.shared();
        let giving = given_away(shared, height);
        let mut message = Writer::default();
        let read = if giving.is_empty() { Ok(Vec::new()) } else { plane.rows(giving.clone()) };
        message.singles(&agreed(ranks, read)?);
        let to =
            (!giving.is_empty()).then(|| writer_of(shared, ranks.count(), giving.start / height * height));
        let from = (ranks.rank() + 1..ranks.count()).filter(|&rank| {
            let given = given_away(&shared.of_rank(rank), height);
            !given.is_empty() && shared.own().contains(&(given.start / height * height))
        });
        let given: Vec<_> =
            to.map(|to| (to, message.0)).into_iter().chain(from.map(|rank| (rank, Vec::new()))).collect();
        let taken = if given.is_empty() { Vec::new() } else { ranks.trade(given)? };
        let mut south = Vec::new();
        for message in taken.iter().filter(|message| !message.is_empty()) {
            let first = south.len();
            south.resize(first + message.len() / size_of::<f32>(), 0.0);
            Reader(message).singles(&mut south[first..])?;
        }
        Ok(Self { plane, height, south })
    }

    /// The rows of each of its strips.
    pub fn own(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let (own, height, all) = (self.plane.own(), self.height, self.plane.shared().count());
        let first = own.start.div_ceil(height) * height;
        (first..own.end.max(first)).step_by(height).map(move |first| first..(first + height).min(all))
    }

    /// The values of one of its strips.
    ///
    /// # Errors
    /// Those of the disk.
    pub fn read(&self, strip: Range<usize>) -> Result<Vec<f32>, Error> {
        let end = self.plane.own().end;
        let mut values = self.plane.rows(strip.start..strip.end.min(end))?;
        if strip.end > end {
            values.extend_from_slice(&self.south);
        }
        Ok(values)
    }
}

/// The rows of a rank that lie in a strip of another.
fn given_away(shared: &SharedRows, height: usize) -> Range<usize> {
    let own = shared.own();
    own.start..(own.start.div_ceil(height) * height).clamp(own.start, own.end)
}

/// The rank that has a row.
fn writer_of(shared: &SharedRows, count: usize, row: usize) -> usize {
    let has_it = |&rank: &usize| shared.of_rank(rank).own().contains(&row);
    (0..count).find(has_it).expect("ranks have all rows among them")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::ranks_in_threads;

    #[test]
    fn each_row_is_read_once_with_the_strip_in_which_it_lies() {
        for (rows, count, height) in [(500, 1, 256), (500, 4, 256), (290, 6, 64), (130, 4, 256), (700, 6, 33)]
        {
            let of_rank = |ranks: std::sync::Arc<dyn Ranks>| {
                let shared = SharedRows::of((ranks.rank(), count), rows);
                let mut plane = StoredPlane::new("test", None, (2, &shared)).expect("room");
                for y in shared.own() {
                    plane.set_rows(y..y + 1, &[y as f32, -(y as f32)]).expect("its own");
                }
                let strips = Strips::of(&plane, height, &*ranks).expect("all are there");
                let read = |strip: Range<usize>| (strip.clone(), strips.read(strip).expect("held"));
                strips.own().map(read).collect::<Vec<_>>()
            };
            let all: Vec<_> = std::thread::scope(|scope| {
                let running: Vec<_> =
                    ranks_in_threads(count).into_iter().map(|ranks| scope.spawn(|| of_rank(ranks))).collect();
                running.into_iter().flat_map(|rank| rank.join().expect("no panic")).collect()
            });
            let mut next = 0;
            for (strip, values) in all {
                assert_eq!((strip.start, strip.end), (next, (next + height).min(rows)), "over {count}");
                let expected: Vec<f32> = strip.clone().flat_map(|y| [y as f32, -(y as f32)]).collect();
                assert_eq!(values, expected, "{strip:?} of {rows} over {count}");
                next = strip.end;
            }
            assert_eq!(next, rows);
        }
    }
}
