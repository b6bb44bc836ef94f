//! What a program needs that makes, changes and saves a landscape of its own: `use weald::prelude::*`, or by name.

pub use crate::landscape_ext::LandscapeExt;
pub use crate::steps;
pub use weald_core::{Domain, Error, Landscape, Size};
pub use weald_land::edit::{Brush, Effect};
