//! Tiles in turn, until none has news for another.

use std::collections::VecDeque;

use super::tiling::Tiling;
use weald_core::error::Error;

/// Visits every tile, and again each that a later visit of another names, until none is left. A visit gives the tiles for
/// which something changed.
pub(super) fn settle(
    tiling: &Tiling,
    mut visit: impl FnMut(usize) -> Result<Vec<usize>, Error>,
) -> Result<(), Error> {
    let mut queue: VecDeque<usize> = (0..tiling.count()).collect();
    let mut is_queued = vec![true; tiling.count()];
    while let Some(tile) = queue.pop_front() {
        is_queued[tile] = false;
        for woken in visit(tile)? {
            if !std::mem::replace(&mut is_queued[woken], true) {
                queue.push_back(woken);
            }
        }
    }
    Ok(())
}

/// The tiles beside which these border cells lie.
pub(super) fn beside(tiling: &Tiling, cells: impl IntoIterator<Item = [usize; 2]>) -> Vec<usize> {
    let mut tiles: Vec<usize> = cells
        .into_iter()
        .flat_map(|cell| tiling.across_from(cell))
        .map(|cell| tiling.tile_of(cell))
        .collect();
    tiles.sort_unstable();
    tiles.dedup();
    tiles
}
