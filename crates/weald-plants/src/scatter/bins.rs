//! Where the places of a window are: a bin for each square of the first round, which holds one place at most.

use super::pattern::{LEVELS, Pattern, Place, Square, squared};

/// No place.
const NONE: u32 = u32::MAX;

/// Nothing is known of what else is in the square.
const UNRESOLVED: u32 = u32::MAX - 1;

/// The bins of a level.
pub(super) struct Bins {
    level: usize,
    first: [i64; 2],
    counts: [i64; 2],
    side: f64,
    content: Vec<u32>,
    /// Widest disc that there may be, in metres; 0 as long as there is nothing.
    widest: f64,
    /// Widest disc of the level.
    greatest: f64,
}

impl Bins {
    /// The bins of a rectangle, given in squares of the last level.
    pub(super) fn new(pattern: &Pattern<'_>, level: usize, [low, high]: [[i64; 2]; 2]) -> Self {
        let factor = 1 << (LEVELS - 1 - level);
        let first = low.map(|at| at * factor);
        let counts = [0, 1].map(|axis| (high[axis] - low[axis]) * factor);
        let content = vec![NONE; (counts[0] * counts[1]) as usize];
        let greatest = pattern.greatest(level);
        Self { level, first, counts, side: pattern.side(level), content, widest: 0.0, greatest }
    }

    /// The squares of the first round.
    pub(super) fn squares(&self) -> impl Iterator<Item = Square> + use<> {
        let (level, first, [columns, rows]) = (self.level, self.first, self.counts);
        (0..columns * rows).map(move |bin| {
            let at = [first[0] + bin % columns, first[1] + bin / columns];
            Square { level, cuts: 0, at }
        })
    }

    /// Puts a place into its bin.
    pub(super) fn put(&mut self, number: usize, place: &Place) {
        let bin = self.at(place.at);
        self.content[bin] = number as u32;
        self.widest = self.widest.max(place.diameter);
    }

    /// Says that nothing is known of the rest of the square at a place.
    pub(super) fn mark_unresolved(&mut self, at: [f64; 2]) {
        let bin = self.at(at);
        self.content[bin] = UNRESOLVED;
        self.widest = self.greatest;
    }

    /// The place in a bin.
    pub(super) fn place(&self, bin: usize) -> Option<usize> {
        Some(self.content[bin]).filter(|&content| content < UNRESOLVED).map(|content| content as usize)
    }

    pub(super) fn is_unresolved(&self, bin: usize) -> bool {
        self.content[bin] == UNRESOLVED
    }

    pub(super) fn is_in_fog_at(&self, at: [f64; 2]) -> bool {
        self.is_unresolved(self.at(at))
    }

    /// Whether nothing is known to be in a bin.
    pub(super) fn is_free(&self, square: Square) -> bool {
        let [x, y] = [0, 1].map(|axis| square.at[axis] - self.first[axis]);
        self.content[(y * self.counts[0] + x) as usize] == NONE
    }

    /// How far the middle of a disc of half that width may be from one that it meets here.
    pub(super) fn reach(&self, half: f64) -> f64 {
        half + 0.5 * self.widest
    }

    /// The bins that come as near as that.
    pub(super) fn near(&self, at: [f64; 2], reach: f64) -> impl Iterator<Item = usize> + use<> {
        let end = |axis: usize, extent: f64| self.index(axis, at[axis] + extent);
        let (rows, from, to) = if self.widest == 0.0 {
            (0..0, 0, 0)
        } else {
            (end(1, -reach)..end(1, reach) + 1, end(0, -reach), end(0, reach))
        };
        let columns = self.counts[0];
        rows.flat_map(move |y| (y * columns + from..=y * columns + to).map(|bin| bin as usize))
    }

    /// The square of the distance from a place to the nearest point of a bin.
    pub(super) fn distance_squared(&self, bin: usize, at: [f64; 2]) -> f64 {
        let bin = [bin as i64 % self.counts[0], bin as i64 / self.counts[0]];
        let nearest = [0, 1].map(|axis| {
            let low = (self.first[axis] + bin[axis]) as f64 * self.side;
            at[axis].clamp(low, low + self.side)
        });
        squared(nearest, at)
    }

    fn at(&self, at: [f64; 2]) -> usize {
        (self.index(1, at[1]) * self.counts[0] + self.index(0, at[0])) as usize
    }

    fn index(&self, axis: usize, along: f64) -> i64 {
        ((along.max(0.0) / self.side) as i64 - self.first[axis]).clamp(0, self.counts[axis] - 1)
    }
}
