//! What every part of **Weald** stands on: grids, domains, landscapes, materials, parameters, random numbers, errors.
//!
//! A [`Landscape`] is a [`Domain`] (columns, rows, cell size, georeference, valid cells) with named layers, each a
//! [`Field`] with a unit. [`parameters!`] declares the parameters of a step, with unit, range and default, once for
//! parsing, errors, documentation and user interfaces.
//!
//! ```
//! use weald_core::{Domain, Field, Landscape, Size};
//!
//! let mut landscape = Landscape::new(Domain::new(Size::new(3, 2)?, 10.0)); // columns, rows; metres
//! let slope = Field::from_function(landscape.domain.size, |x, _| 5.0 * x as f32);
//! landscape.insert("height", "m", slope);
//! assert_eq!(landscape.field("height")?.at(2, 1), 10.0);
//! # Ok::<(), weald_core::Error>(())
//! ```
//!
//! Row 0 is north, `x` counts columns eastward and `y` rows southward. Heights and lengths are in metres unless
//! a name says otherwise, angles in degrees carry the suffix `_deg`. [`Error`] is sorted by who must act.

pub mod attachment;
pub mod condition;
pub mod connected;
pub mod domain;
pub mod error;
pub mod file_plane;
pub mod files;
pub mod grain;
pub mod grid;
pub mod landscape;
pub mod layer_words;
pub mod material;
pub mod parameter;
pub mod plane;
pub mod plants;
pub mod random;
pub mod sea;
pub mod source;
pub mod strata;
pub mod vectors;

pub use attachment::Attachment;
pub use domain::Domain;
pub use error::Error;
pub use grid::{Field, Size};
pub use landscape::Landscape;
