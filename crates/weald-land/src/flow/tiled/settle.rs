//! Visits of tiles until none has news for another, on any rank.

use std::collections::VecDeque;
use std::ops::Range;

use super::borders::{Borders, Sent};
use super::tiling::{Tiling, beside};
use weald_core::error::Error;
use weald_engine::ranks::{agreed, any};

/// Tiles of this rank that are to be visited, each once at a time.
struct Queue {
    own: Range<usize>,
    tiles: VecDeque<usize>,
    is_queued: Vec<bool>,
}

impl Queue {
    /// All of them.
    fn of(own: Range<usize>) -> Self {
        Self { tiles: own.clone().collect(), is_queued: vec![true; own.len()], own }
    }

    /// Adds those of some tiles that are this rank's.
    fn add(&mut self, tiles: Vec<usize>) {
        for tile in tiles.into_iter().filter(|tile| self.own.contains(tile)) {
            if !std::mem::replace(&mut self.is_queued[tile - self.own.start], true) {
                self.tiles.push_back(tile);
            }
        }
    }

    fn next(&mut self) -> Option<usize> {
        let tile = self.tiles.pop_front()?;
        self.is_queued[tile - self.own.start] = false;
        Some(tile)
    }
}

/// Visits every tile of this rank, and again each that a later visit of another or news of other ranks name, until none is
/// left on any rank. A visit gives the tiles for which something changed, and changes what is `known` of border cells.
pub(super) fn settle<T: Copy + PartialEq + Sent>(
    tiling: &Tiling,
    known: &mut Borders<T>,
    mut visit: impl FnMut(usize, &mut Borders<T>) -> Result<Vec<usize>, Error>,
) -> Result<(), Error> {
    let mut queue = Queue::of(tiling.own());
    loop {
        agreed(tiling.ranks(), visit_all(&mut queue, |tile| visit(tile, known)))?;
        queue.add(beside(tiling, known.swap(tiling)?));
        if !any(tiling.ranks(), !queue.tiles.is_empty())? {
            return Ok(());
        }
    }
}

fn visit_all(
    queue: &mut Queue,
    mut visit: impl FnMut(usize) -> Result<Vec<usize>, Error>,
) -> Result<(), Error> {
    while let Some(tile) = queue.next() {
        queue.add(visit(tile)?);
    }
    Ok(())
}
