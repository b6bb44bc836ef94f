//! **Weald** turns a recipe into a living landscape.
//!
//! A recipe is checked whole, then run: generators make ground, simulations carve it, and the layers go out
//! as files. This crate holds no window, no command line and no GPU interface.

pub mod analyse;
pub mod bench;
pub mod combine;
pub mod domain;
pub mod engine;
pub mod erode;
pub mod error;
pub mod gallery;
pub mod generate;
pub mod grid;
pub mod io;
pub mod landscape;
pub mod picture;
pub mod random;
pub mod recipe;
pub mod stencil;
pub mod step;
pub mod vectors;

pub use domain::Domain;
pub use error::Error;
pub use grid::{Field, Size};
pub use landscape::Landscape;
