//! A plant as leaves on limbs, to be drawn in real time: in levels of detail that blend into each other, and in the
//! wind.
//!
//! What [`foliage`](super::foliage) covers with pictures is here cut from the codes alone. The first digit that makes a part
//! small enough makes it a **leaf**, an outline of the whole under the map of the part; each [level](LEVELS) has its own
//! bound on what is small, so leaves of a coarser level are those from which the finer ones hang (`walk.rs`). Where two
//! levels meet, the leaves of one become narrower as those of the other become broader, and all levels have the same area
//! of leaves, so that nothing leaps. Each digit of a branch begins a **limb**, which turns about its joint (`sway.rs`).

mod device;
mod hull;
mod leaf;
mod limb;
mod outline;
mod place;
mod stem;
mod sway;
#[cfg(test)]
mod tests;
mod walk;

pub use device::{BEND, FUNCTIONS};
pub use limb::{Corner, LEVELS, Limb, Limbs};
pub use sway::{LocalWind, wind_on};
