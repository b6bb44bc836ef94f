//! Pictures of fractals: the density of their points as light, or their parts as sharp marks.
//!
//! A [`Look`] says how a fractal is drawn; it is the one declaration for recipes and for `weald fractal`. A
//! [`Subject`] is what is drawn: a fractal, whatever moves its points, and a [`Camera`].

mod camera;
mod colouring;
mod density;
mod frame;
mod look;
mod marks;
mod palette;
mod plot;
mod subject;
mod svg;
#[cfg(test)]
mod tests;
mod tone;

pub use camera::Camera;
pub use colouring::ColourBy;
pub use density::{Bucket, Density, Sampling};
pub use frame::{Extent, Frame};
pub use look::{Background, Draw, Look, Setting};
pub use palette::Palette;
pub use subject::{Motion, Subject};
pub use tone::Tone;
