//! The places of a [pattern](super::pattern), tile by tile.

use rayon::prelude::*;

use super::pattern::{LEVELS, Pattern, Place, SPARSEST};
use super::window::Window;
use weald_core::error::Error;
use weald_core::random::unit;
use weald_engine::Watcher;

/// Side of a tile, in squares of the last level.
const TILE: i64 = 48;

/// Use of random bits, beside those of a pattern.
const RETENTION: u64 = 3;

impl Pattern<'_> {
    /// All places, from north to south, or an error where the watcher ends the work.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn places(&self, watcher: &dyn Watcher) -> Result<Vec<Place>, Error> {
        self.in_tiles(TILE, watcher)
    }

    /// The same by tiles of that many squares a side.
    pub(super) fn in_tiles(&self, tile: i64, watcher: &dyn Watcher) -> Result<Vec<Place>, Error> {
        let side = self.side(LEVELS - 1);
        let [across, down] = self.ground.extent().map(|length| (length / side) as i64 / tile + 1);
        let tiles = (0..across * down).into_par_iter().map(|number| {
            if watcher.cancelled() {
                return Err(Error::Interrupted(String::new()));
            }
            let (x, y) = (tile * (number % across), tile * (number / across));
            Ok(self.tile([[x, y], [x + tile, y + tile]]))
        });
        let mut places = tiles.collect::<Result<Vec<_>, Error>>()?.concat();
        let key = |place: &Place| (place.at[1].to_bits(), place.at[0].to_bits());
        places.par_sort_unstable_by_key(key);
        Ok(places)
    }

    /// The places in a rectangle of squares of the last level.
    ///
    /// The tile is settled with a margin around it, where places near its outer edge are unknown, since what lies
    /// beyond may go before them. Where the tile itself has an unknown place the margin is doubled.
    pub(super) fn tile(&self, tile: [[i64; 2]; 2]) -> Vec<Place> {
        const MARGIN: i64 = 4;
        let side = self.side(LEVELS - 1);
        let [_, most] = self.ground.bounds(tile.map(|corner| corner.map(|at| at as f64 * side)));
        if most <= 0.0 {
            return Vec::new();
        }
        let mut margin = MARGIN;
        loop {
            if let Some(places) = Window::around(self, tile, margin).settled() {
                return places.into_iter().filter(is_drawn).collect();
            }
            margin *= 2;
        }
    }
}

/// Whether a place on the sparsest ground is among those that are kept.
fn is_drawn(place: &Place) -> bool {
    unit(place.bits(RETENTION)) * SPARSEST < place.suitability
}
