//! The lists that plants are sorted into, one for each level of detail and each transition, for each view.

use crate::render::cascades::CASCADES;

/// Views: the camera's, and one for each cascade.
pub(super) const VIEWS: usize = 1 + CASCADES;

/// Lists of a view: a level of detail alone, or with what it passes into.
pub(super) const LISTS: usize = 2 * weald::grow::ifs::limbs::LEVELS;
