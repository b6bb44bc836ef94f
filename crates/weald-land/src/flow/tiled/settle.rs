//! Visits of tiles until none has news for another, on any rank.

use std::collections::VecDeque;
use std::ops::Range;

use rayon::prelude::*;

use super::borders::{Borders, Sent};
use super::tiling::{Tiling, beside};
use weald_core::error::Error;
use weald_engine::ranks::{agreed, any};

/// Called after each visit of a tile with the number of its cells; an error ends the work.
pub type Passed<'a> = &'a mut dyn FnMut(usize) -> Result<(), Error>;

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
    until_settled(tiling, known, |queue, known| {
        let Some(tile) = queue.next() else { return Ok(()) };
        queue.add(visit(tile, known)?);
        Ok(())
    })
}

/// What a visit of a tile has found.
pub(super) struct Visited {
    /// The tiles for which something changed.
    pub(super) woken: Vec<usize>,
    /// Whether no visit of the tile will find more.
    pub(super) is_done: bool,
}

/// Tiles that are looked at side by side, together no larger than a large one. More know less of each other, and are visited
/// again.
const SIDE_BY_SIDE: usize = 16;

/// As [`settle`], for small tiles: several look side by side at a `plane` and at what is known before, and what each has
/// seen is then taken one after another. So what is found must not depend on when a tile is visited. Gives which tiles of this
/// rank are done.
pub(super) fn settle_side_by_side<T, P, S>(
    (tiling, known, plane): (&Tiling, &mut Borders<T>, &mut P),
    look: impl Fn(usize, &Borders<T>, &P) -> Result<S, Error> + Sync,
    mut take: impl FnMut(usize, S, &mut Borders<T>, &mut P) -> Result<Visited, Error>,
) -> Result<Vec<bool>, Error>
where
    T: Copy + PartialEq + Sent + Send + Sync,
    P: Sync + ?Sized,
    S: Send,
{
    let own = tiling.own();
    let mut is_done = vec![false; own.len()];
    until_settled(tiling, known, |queue, known| {
        let next = std::iter::from_fn(|| queue.next()).filter(|tile| !is_done[tile - own.start]);
        let tiles: Vec<usize> = next.take(SIDE_BY_SIDE).collect();
        let seen: Vec<_> = tiles.par_iter().map(|&tile| look(tile, known, plane)).collect();
        for (tile, seen) in tiles.into_iter().zip(seen) {
            let visited = take(tile, seen?, known, plane)?;
            is_done[tile - own.start] = visited.is_done;
            queue.add(visited.woken);
        }
        Ok(())
    })?;
    Ok(is_done)
}

/// Lets tiles be visited until no rank has any left.
fn until_settled<T: Copy + PartialEq + Sent>(
    tiling: &Tiling,
    known: &mut Borders<T>,
    mut visit: impl FnMut(&mut Queue, &mut Borders<T>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut queue = Queue::of(tiling.own());
    loop {
        let mut visited = Ok(());
        while visited.is_ok() && !queue.tiles.is_empty() {
            visited = visit(&mut queue, known);
        }
        agreed(tiling.ranks(), visited)?;
        queue.add(beside(tiling, known.swap(tiling)?));
        if !any(tiling.ranks(), !queue.tiles.is_empty())? {
            return Ok(());
        }
    }
}
