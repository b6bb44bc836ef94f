//! A rectangle of a pattern with a margin, settled by itself.
//!
//! A candidate that a place overlaps is out. One that may be overlapped by something beyond the window is unknown, and
//! marks its square unresolved: from there on no candidate is drawn in it, and what might overlap with something in it
//! is unknown too. All others are places, and the same that the whole has there.

use super::bins::Bins;
use super::pattern::{LEVELS, Pattern, Place, Square, overlap, squared};

/// Rounds before squares are cut for the first time.
const ROUNDS: u8 = 3;

/// A rectangle of a pattern.
pub(super) struct Window<'a> {
    pattern: &'a Pattern<'a>,
    /// North-western and south-eastern corner of what is to be found, in metres.
    tile: [[f64; 2]; 2],
    /// How far discs may reach without meeting one from beyond the margin.
    inner: [[f64; 2]; 2],
    bins: [Bins; LEVELS],
    places: Vec<Place>,
}

/// What the places around a candidate make of it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Place,
    Unknown,
    Out,
}

/// A candidate of the tile is unknown: the margin is too narrow.
struct MarginTooNarrow;

impl<'a> Window<'a> {
    /// The tile, a rectangle of squares of the last level, with a margin of so many of them.
    pub(super) fn around(pattern: &'a Pattern<'a>, tile: [[i64; 2]; 2], margin: i64) -> Self {
        let side = pattern.side(LEVELS - 1);
        let count = pattern.ground.extent().map(|length| (length / side) as i64 + 1);
        let low = tile[0].map(|at| (at - margin).max(0));
        let high = [0, 1].map(|axis| (tile[1][axis] + margin).min(count[axis]));
        let reach = 0.5 * pattern.greatest(LEVELS - 1);
        // There are no discs beyond the landscape.
        let first = |at: i64| if at == 0 { f64::NEG_INFINITY } else { at as f64 * side + reach };
        let last = |axis: usize| {
            if high[axis] == count[axis] { f64::INFINITY } else { high[axis] as f64 * side - reach }
        };
        Self {
            pattern,
            tile: tile.map(|corner| corner.map(|at| at as f64 * side)),
            inner: [low.map(first), [last(0), last(1)]],
            bins: std::array::from_fn(|level| Bins::new(pattern, level, [low, high])),
            places: Vec::new(),
        }
    }

    /// The places of the tile; `None` where the margin is too narrow to know them.
    pub(super) fn settled(mut self) -> Option<Vec<Place>> {
        let mut open = self.pattern.squares_in(self.bins[LEVELS - 1].squares());
        open.retain(|square| self.pattern.least_in(*square).is_some());
        for round in 0..ROUNDS {
            self.draw(&open, round).ok()?;
            open.retain(|square| self.bins[square.level].is_free(*square));
        }
        for cut in 0..self.pattern.cuts {
            open = self.quarters_with_room(&open);
            self.draw(&open, ROUNDS + cut).ok()?;
        }
        self.places.retain(|place| is_in(self.tile, place.at));
        Some(self.places)
    }

    /// Judges the candidates of a round in their order.
    fn draw(&mut self, open: &[Square], round: u8) -> Result<(), MarginTooNarrow> {
        let mut candidates: Vec<_> = open
            .iter()
            .filter_map(|&square| Some((self.pattern.candidate(square, round)?, square.level)))
            .collect();
        candidates.sort_unstable_by_key(|(place, _)| place.rank);
        for (candidate, level) in candidates {
            match self.verdict(&candidate) {
                Verdict::Out => {}
                Verdict::Place => {
                    self.bins[level].put(self.places.len(), &candidate);
                    self.places.push(candidate);
                }
                Verdict::Unknown if is_in(self.tile, candidate.at) => return Err(MarginTooNarrow),
                Verdict::Unknown => self.bins[level].mark_unresolved(candidate.at),
            }
        }
        Ok(())
    }

    fn verdict(&self, candidate: &Place) -> Verdict {
        let half = 0.5 * candidate.diameter;
        let [low, high] = self.inner;
        let fits =
            |axis: usize| candidate.at[axis] - half >= low[axis] && candidate.at[axis] + half <= high[axis];
        let mut is_known = fits(0) && fits(1);
        for bins in &self.bins {
            let reach = bins.reach(half);
            for bin in bins.near(candidate.at, reach) {
                if bins.place(bin).is_some_and(|place| overlap(&self.places[place], candidate)) {
                    return Verdict::Out;
                }
                is_known &=
                    !(bins.is_unresolved(bin) && bins.distance_squared(bin, candidate.at) < reach * reach);
            }
        }
        if is_known { Verdict::Place } else { Verdict::Unknown }
    }

    /// The quarters of squares that may hold places, and have room for one.
    fn quarters_with_room(&self, open: &[Square]) -> Vec<Square> {
        let (mut around, mut found) = (Vec::new(), Vec::new());
        for &square in open {
            self.find_around(square, &mut around);
            found.extend(
                square.quarters().into_iter().filter(|quarter| self.may_hold_more(*quarter, &around)),
            );
        }
        found
    }

    /// The places that may leave a quarter of a square without room. The middle of the square is a corner of each quarter,
    /// so that a disc which covers a quarter reaches it.
    fn find_around(&self, square: Square, found: &mut Vec<Place>) {
        found.clear();
        let (middle, half) = (self.middle(square), 0.5 * self.pattern.greatest(square.level));
        for bins in &self.bins {
            let near = bins.near(middle, bins.reach(half)).filter_map(|bin| bins.place(bin));
            found.extend(near.map(|place| self.places[place]).filter(|place| {
                let apart = half + 0.5 * place.diameter;
                squared(place.at, middle) < apart * apart
            }));
        }
    }

    /// Whether a square may hold places, and has room for one between those around it.
    fn may_hold_more(&self, square: Square, around: &[Place]) -> bool {
        // Most squares are under a disc of their level already, or soon known to hold none, by rough bounds.
        !self.bins[square.level].is_in_fog_at(self.middle(square))
            && self.has_room(square, self.pattern.least(square.level), around)
            && self.pattern.least_roughly_in(square).is_some_and(|least| self.has_room(square, least, around))
            && self.pattern.least_in(square).is_some_and(|least| self.has_room(square, least, around))
    }

    /// Whether a square is not so deep under a single disc that no other of that diameter has room.
    fn has_room(&self, square: Square, diameter: f64, around: &[Place]) -> bool {
        let ([low, high], middle) = (self.pattern.corners(square), self.middle(square));
        let covers = |place: &Place| {
            let at = place.at;
            let farthest = [0, 1].map(|axis| if at[axis] < middle[axis] { high[axis] } else { low[axis] });
            let apart = 0.5 * (diameter + place.diameter);
            squared(at, farthest) < apart * apart
        };
        !around.iter().any(covers)
    }

    /// The middle of a square, in metres.
    fn middle(&self, square: Square) -> [f64; 2] {
        let [low, high] = self.pattern.corners(square);
        [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))
    }
}

fn is_in([low, high]: [[f64; 2]; 2], at: [f64; 2]) -> bool {
    (0..2).all(|axis| at[axis] >= low[axis] && at[axis] < high[axis])
}
