//! The widest spacing at which a number of places finds room.
//!
//! On wide ground the number goes with one over the square of the spacing, on narrow patches, over whose edges discs stand
//! out, with a lower power, which two tries tell; each try follows from the last. What is known to be too wide or too
//! narrow bounds it. The first try stops after the first rounds, whose share of all places is known well enough to begin
//! with; the others after two cuts, since what later ones find would be the last ranks, which are left out again. So the
//! spacing is a few hundredths below the widest that there is. At the least spacing all room is looked for.

use super::pattern::{CUTS, DENSITY, Place};
use weald_core::error::Error;

/// By how much more places than are asked for a spacing may have, and be the widest.
const SURPLUS: f64 = 1.03;

/// Places beyond those asked for that a try aims at: the middle of what is allowed.
const TARGET_SURPLUS: f64 = 1.015;

/// Spacings that are tried.
const TRIES: usize = 12;

/// Cuts of squares in a try.
const CUTS_OF_A_TRY: u8 = 2;

/// Places after so many cuts beside those of the first rounds alone, in the recipe `highland`.
const GAIN: f64 = 1.11;

/// So many places, and the widest spacing at which they find room, down to the least; fewer where that has no room for
/// them. `at` gives the places of a spacing, found with so many cuts, on ground of so many square metres.
///
/// # Errors
/// Those of `at`.
pub(super) fn widest(
    count: usize,
    least: f64,
    area: f64,
    at: impl Fn(f64, u8) -> Result<Vec<Place>, Error>,
) -> Result<(f64, Vec<Place>), Error> {
    let mut search = Search { count: count as f64, least, narrow: None, wide: f64::INFINITY, last: None };
    let expected = (DENSITY * area / (TARGET_SURPLUS * search.count)).sqrt().max(least);
    let found = GAIN * at(expected, 0)?.len() as f64;
    let mut spacing = search.scaled(expected, found, 2.0).max(least);
    for _ in 0..TRIES {
        let places = at(spacing, if spacing <= least { CUTS } else { CUTS_OF_A_TRY })?;
        if spacing <= least && places.len() < count {
            return Ok((spacing, places));
        }
        let is_near = places.len() as f64 <= SURPLUS * search.count;
        if is_near && places.len() >= count {
            return Ok((spacing, first_ranks(places, count)));
        }
        spacing = search.next(spacing, places);
    }
    let (spacing, places) = match search.narrow {
        Some(found) => found,
        None => (least, at(least, CUTS)?),
    };
    Ok((spacing, first_ranks(places, count)))
}

/// What the tries have told.
struct Search {
    /// Places that are asked for.
    count: f64,
    /// Least spacing.
    least: f64,
    /// The widest spacing that is known to have enough places, and those.
    narrow: Option<(f64, Vec<Place>)>,
    /// The narrowest spacing that is known to have too few.
    wide: f64,
    /// Logarithms of the last spacing and of its number of places.
    last: Option<(f64, f64)>,
}

impl Search {
    /// The spacing to try after one that has these places.
    fn next(&mut self, spacing: f64, places: Vec<Place>) -> f64 {
        let found = places.len().max(1) as f64;
        let power = self.power(spacing, found);
        let next = self.scaled(spacing, found, power);
        if found >= self.count {
            self.narrow = Some((spacing, places));
        } else {
            self.wide = spacing;
        }
        match &self.narrow {
            None if next < self.wide => next.max(self.least),
            None => 0.5 * (self.least + self.wide),
            Some((narrow, _)) if next > *narrow && next < self.wide => next,
            Some((narrow, _)) => 0.5 * (narrow + self.wide.min(2.0 * narrow)),
        }
    }

    /// The power of one over the spacing with which the number of places goes, by this try and the last.
    fn power(&mut self, spacing: f64, found: f64) -> f64 {
        let here = (libm::log(spacing), libm::log(found));
        let before = self.last.replace(here).filter(|before| before.0 != here.0);
        before.map_or(2.0, |before| ((before.1 - here.1) / (here.0 - before.0)).clamp(1.0, 2.0))
    }

    /// The spacing that has the number aimed at where another one has `found`.
    fn scaled(&self, spacing: f64, found: f64, power: f64) -> f64 {
        spacing * libm::pow(found.max(1.0) / (TARGET_SURPLUS * self.count), 1.0 / power)
    }
}

/// The places of the first ranks, in the order in which they came.
fn first_ranks(mut places: Vec<Place>, count: usize) -> Vec<Place> {
    if count < places.len() {
        let mut ranks: Vec<_> = places.iter().map(|place| place.rank).collect();
        let (_, &mut last, _) = ranks.select_nth_unstable(count - 1);
        places.retain(|place| place.rank <= last);
    }
    places
}
