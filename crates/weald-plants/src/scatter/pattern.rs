//! Places that keep their distance: blue noise whose density follows the ground.
//!
//! Each place has a disc of its own, of diameter `r`, and no two discs overlap:
//!
//! ```text
//! |a - b| ≥ (r(a) + r(b)) / 2          r = spacing / √max(s, 1/64)
//! ```
//!
//! with the suitability `s` of the ground, so that `s` is the density beside the densest. Ground of `s` below 1/64 has
//! discs of eight spacings, of which a share of 64 `s` is kept, at random.
//!
//! Candidates come in rounds. In each, a square that may still have room has one candidate at a random place; between
//! some rounds, squares become four, and those that lie under a disc are dropped (Ebeida et al. 2012, doi
//! 10.1111/j.1467-8659.2012.03059.x). Candidates of earlier rounds go before later ones, those of one round in the order
//! of their hashes, and each stays unless it overlaps one that stays before it: the maximal independent set of random
//! priorities (Luby 1986, doi 10.1137/0215074; for discs Wei 2008, doi 10.1145/1360612.1360619). The hashes are functions
//! of seed, round and square alone, so the set does not depend on the order of work, and each [tile](super::tiles) of it
//! can be found by itself. What differs from the sources: the set is that of all candidates of all rounds, not one that
//! threads or phases decide; squares come in three sizes, for discs of up to two, four and eight spacings, so that a
//! square of the first round holds one place at most.

use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::RangeInclusive;

use weald_core::random::{hash2, splitmix64, unit};

/// Sizes of squares: each holds places whose discs are from 2^level up to twice that many spacings wide.
pub(super) const LEVELS: usize = 3;

/// Widest disc, in spacings.
const WIDEST: f64 = 8.0;

/// Suitability of the widest disc.
pub(super) const SPARSEST: f64 = 1.0 / (WIDEST * WIDEST);

/// Discs of one diameter that fit on a square as wide as that, when no more have room.
pub(super) const DENSITY: f64 = 0.695;

/// Cuts after which hardly any room is left: a sixty-fourth of a square of the first round.
pub(super) const CUTS: u8 = 6;

/// Ground that places look for.
pub(super) trait Suitability: Sync {
    /// Metres from west to east and from north to south.
    fn extent(&self) -> [f64; 2];

    /// How well a place suits, from 0 to 1; 0 where there is no ground.
    fn suitability(&self, place: [f64; 2]) -> f64;

    /// Least and greatest suitability that places between two corners can have.
    fn bounds(&self, corners: [[f64; 2]; 2]) -> [f64; 2];

    /// The same, as wide or wider, where less work gives them.
    fn rough_bounds(&self, corners: [[f64; 2]; 2]) -> [f64; 2] {
        self.bounds(corners)
    }
}

/// A pattern of places: what it depends on.
pub(super) struct Pattern<'a> {
    /// The ground.
    pub(super) ground: &'a dyn Suitability,
    /// Least distance in metres.
    pub(super) spacing: f64,
    /// Another seed, other places.
    pub(super) seed: u64,
    /// How often squares are cut into four, with a round after each: [`CUTS`], or fewer where not all room is to be found.
    pub(super) cuts: u8,
}

/// A place of the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Metres east and south of the north-western corner.
    pub(super) at: [f64; 2],
    /// How well the ground suits.
    pub(super) suitability: f64,
    /// Diameter of its disc in metres.
    pub(super) diameter: f64,
    /// Places of earlier rounds go first, then lower hashes.
    pub(super) rank: (u8, u64),
}

impl Place {
    /// Random bits of this place for one use.
    pub(super) fn bits(&self, purpose: u64) -> u64 {
        splitmix64(self.rank.1 ^ splitmix64(purpose ^ (u64::from(self.rank.0) << 32)))
    }
}

/// Uses of random bits; those of others begin at 8.
const ACROSS: u64 = 1;
const DOWN: u64 = 2;

/// A square in which candidates are drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    /// Which discs it is for.
    pub level: usize,
    /// How often it was cut into four.
    pub(super) cuts: u8,
    /// Column and row among squares of its size.
    pub(super) at: [i64; 2],
}

impl Square {
    /// Its quarters.
    pub(super) fn quarters(self) -> [Self; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| {
            let at = [2 * self.at[0] + dx, 2 * self.at[1] + dy];
            Self { cuts: self.cuts + 1, at, ..self }
        })
    }
}

impl Pattern<'_> {
    /// Side in metres of the squares of the first round: a disc of their level covers one from any place in it.
    pub(super) fn side(&self, level: usize) -> f64 {
        // A little less than 1 / √2, for rounding.
        const SHARE: f64 = FRAC_1_SQRT_2 * (1.0 - 1e-6);
        SHARE * self.least(level)
    }

    /// Least diameter of the discs of a level.
    pub(super) fn least(&self, level: usize) -> f64 {
        self.spacing * (1_u32 << level) as f64
    }

    /// Greatest diameter of the discs of a level.
    pub(super) fn greatest(&self, level: usize) -> f64 {
        self.least(level + 1).min(WIDEST * self.spacing)
    }

    /// The corners of a square, in metres.
    pub(super) fn corners(&self, square: Square) -> [[f64; 2]; 2] {
        let side = self.side(square.level) / (1_u32 << square.cuts) as f64;
        [square.at.map(|at| at as f64 * side), square.at.map(|at| (at + 1) as f64 * side)]
    }

    /// The candidate of a square in a round, where the ground there is of the square's level.
    pub(super) fn candidate(&self, square: Square, round: u8) -> Option<Place> {
        let stream = hash2(self.seed, square.level as i64, i64::from(round));
        let rank = (round, hash2(stream, square.at[0], square.at[1]));
        let mut place = Place { at: [0.0; 2], suitability: 0.0, diameter: 0.0, rank };
        let [low, high] = self.corners(square);
        for (axis, purpose) in [(0, ACROSS), (1, DOWN)] {
            place.at[axis] = low[axis] + unit(place.bits(purpose)) * (high[axis] - low[axis]);
        }
        let suitability = self.ground.suitability(place.at);
        if level_of(suitability) != Some(square.level) {
            return None;
        }
        let diameter = self.spacing / suitability.max(SPARSEST).sqrt();
        Some(Place { suitability, diameter, ..place })
    }

    /// Squares of all levels in those of the last which may hold places of their level: what bounds a square bounds those
    /// in it.
    pub(super) fn squares_in(&self, last: impl Iterator<Item = Square>) -> Vec<Square> {
        let (mut found, mut within): (Vec<_>, Vec<_>) = (Vec::new(), last.collect());
        while let Some(square) = within.pop() {
            let Some(levels) = self.levels_in(square) else { continue };
            found.extend(levels.contains(&square.level).then_some(square));
            if *levels.start() < square.level {
                within.extend(square.quarters().map(|Square { at, .. }| Square {
                    level: square.level - 1,
                    cuts: 0,
                    at,
                }));
            }
        }
        found
    }

    /// Levels of places that a square may hold; `None` where nothing suits.
    fn levels_in(&self, square: Square) -> Option<RangeInclusive<usize>> {
        let [least, most] = self.ground.rough_bounds(self.corners(square));
        Some(level_of(most)?..=level_of(least).unwrap_or(LEVELS - 1))
    }

    /// Least diameter that discs of a square may have; `None` where it cannot hold places of its level.
    pub(super) fn least_in(&self, square: Square) -> Option<f64> {
        self.least_by(square, self.ground.bounds(self.corners(square)))
    }

    /// The same or less, or one that is none in truth: soon known.
    pub(super) fn least_roughly_in(&self, square: Square) -> Option<f64> {
        self.least_by(square, self.ground.rough_bounds(self.corners(square)))
    }

    fn least_by(&self, square: Square, [least, most]: [f64; 2]) -> Option<f64> {
        let (first, last) = (level_of(most)?, level_of(least).unwrap_or(LEVELS - 1));
        let may_suit = (first..=last).contains(&square.level);
        may_suit.then(|| self.least(square.level).max(self.spacing / most.max(SPARSEST).sqrt()))
    }
}

/// The squares that a place of this suitability is drawn in.
fn level_of(suitability: f64) -> Option<usize> {
    if suitability <= 0.0 {
        return None;
    }
    Some(
        (0..LEVELS - 1)
            .find(|level| suitability > 0.25 / (1_u32 << (2 * level)) as f64)
            .unwrap_or(LEVELS - 1),
    )
}

/// Whether the discs of two places would overlap.
pub(super) fn overlap(a: &Place, b: &Place) -> bool {
    let apart = 0.5 * (a.diameter + b.diameter);
    squared(a.at, b.at) < apart * apart
}

/// The square of a distance.
pub(super) fn squared(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}
