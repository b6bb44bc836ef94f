//! The lists that plants are sorted into, one for each level of detail and each transition, for each view.

use crate::render::cascades::CASCADES;

/// Views: the camera's, and one for each cascade.
pub(super) const VIEWS: usize = 1 + CASCADES;

/// Lists of a view: a level of detail alone, or with what it passes into.
pub(super) const LISTS: usize = 2 * weald::grow::ifs::limbs::LEVELS;

/// Plants of each view whose limbs are carried once for all of their leaves, as the shader has it: views that have none are the last.
pub(super) const SEATS: [u32; VIEWS] = [96, 48, 48, 0, 0];

/// The first list of a view whose plants have no seats of their own, as the shader has it.
pub(super) const SEATED_LISTS: usize = 6;

/// Seats that all other plants share: winds from eight sides of four strengths.
pub(super) const SHARED_SEATS: u32 = 32;

/// How many of them, from the first on, hold leaves of the finest level.
pub(super) const LISTS_OF_FINEST: usize = 2;
