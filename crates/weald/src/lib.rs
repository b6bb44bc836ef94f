//! **Weald** turns a recipe into a living landscape.
//!
//! A [`Recipe`](recipe::Recipe) is checked whole, then [run](recipe::Run): generators make ground, simulations
//! carve it, and the layers go out as files. The result is the same bits for any number of threads and on any
//! [engine](engine::Engine). This crate holds no window, no command line and no GPU interface.
//!
//! ```
//! use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
//!
//! let text = r#"
//!     [landscape]
//!     size = 64
//!     cell = 20.0                 # metres
//!     [[step]]
//!     do = "diamond-square"
//!     relief = 300.0
//!     [[step]]
//!     do = "hydraulic"            # rain carves it
//!     iterations = 240
//!     [[output]]
//!     layer = "height"
//!     file = "height.tif"
//! "#;
//! let recipe = Recipe::parse("hills.toml", text, &Overrides::default())?;
//! # let folder = tempfile::tempdir().expect("a temporary folder");
//! # let out = folder.path();
//! let report = Run { recipe: &recipe, options: Options::into_folder(out) }.execute(&Silent)?;
//!
//! let budget = report.steps[1].budget.expect("a simulation keeps books");
//! assert!(budget.water.error.abs() < 1e-6 && budget.solid.error.abs() < 1e-6);
//! assert!(out.join("height.tif").is_file());
//! # Ok::<(), weald::Error>(())
//! ```
//!
//! Where to go on:
//!
//! * [`recipe`]: what a recipe can say, how it is checked and run; [`recipe::catalog`] lists all steps.
//! * [`generate`], [`combine`], [`erode`]: the steps, one file a method, each with its equation and source.
//! * [`Landscape`], [`Domain`], [`Field`]: layers on a grid with a cell size, a place on Earth, a no-data mask.
//! * [`step::Step`]: what a step declares and does. Run one on a landscape of your own with [`engine::Job`].
//! * [`io`]: raster formats. [`picture`]: maps. [`analyse`]: measures of river networks and shapes.
//! * [`gallery`], [`mod@bench`]: figures of the publications made again, and rates.
//!
//! Row 0 is north, `x` counts columns eastward and `y` rows southward. Heights and lengths are in metres unless
//! a name says otherwise, angles in degrees carry the suffix `_deg`. [`Error`] is sorted by who must act.

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
