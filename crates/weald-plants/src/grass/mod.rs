//! Grass by the blade: each blade's width, height, bend and colour follow from the soil and the light where it stands.
//!
//! Kim and Cho 2009, "Modeling and rendering of growing grass". [`curves`] say what soil and light do; [`growth`] makes of
//! them the points of a stem, level by level; [`spline`] is the smooth stem through them; a [`Blade`] is a ribbon along
//! it; six blades are a [`Set`]. A [`Species`] has its own curves, sizes and colours, and may bear seed heads.

pub mod blade;
pub mod canopy;
pub mod choice;
pub mod curves;
pub mod device;
pub mod growth;
pub mod instance;
pub mod meadow;
#[cfg(test)]
mod meadow_tests;
mod random;
pub mod species;
pub mod spline;
#[cfg(test)]
mod tests;

pub use blade::{BLADES, Blade, Set, Vertex};
pub use canopy::Canopy;
pub use choice::{Choice, ViewCone};
pub use curves::{Curves, LightCurve, SoilCurve};
pub use device::Grasses;
pub use growth::{Bend, Growth, LEVELS};
pub use instance::{Instance, Packed};
pub use meadow::{Area, Maps, Meadow};
pub use species::{SPECIES, Species};
pub use spline::Spline;
