//! **Weald** turns a recipe into a living landscape.
//!
//! A [`Recipe`](recipe::Recipe) is checked whole, then [run](recipe::Run): generators make ground, simulations
//! carve it, and the layers go out as files. The result is the same bits for any number of threads, bands and
//! tiles of an [engine](engine::Engine). This crate holds no window, no command line and no GPU interface: the
//! crate `weald-gpu` brings the last, as an [`engine::device::Device`].
//!
//! ```
//! use weald::recipe::{Overrides, Recipe};
//!
//! let text = r#"
//!     [landscape]
//!     size = [48, 32]        # columns, rows
//!     cell = 20.0            # metres
//!     seed = 7
//!     [[step]]
//!     do = "diamond-square"
//!     relief = 200.0         # metres
//!     [[step]]
//!     do = "hydraulic"
//!     iterations = 120       # 60 wet and 60 dry ones
//!     [[output]]
//!     layer = "height"
//!     file = "height.tif"
//! "#;
//! let recipe = Recipe::parse("valley.toml", text, &Overrides::default())?;
//!
//! // All in memory; `weald::recipe::Run` writes the files, keeps checkpoints and reports.
//! let landscape = recipe.landscape()?;
//! let (height, erosion) = (landscape.field("height")?, landscape.field("erosion")?);
//! assert_eq!((height.size().columns, height.size().rows), (48, 32));
//! let (_, deepest) = erosion.range(None).expect("there are cells");
//! assert!(deepest > 0.01 && deepest < 200.0, "rain has carved up to {deepest} m");
//!
//! // A faulty recipe says where, what is wrong, and what was probably meant.
//! let error = Recipe::parse("valley.toml", &text.replace("relief", "releif"), &Overrides::default());
//! let message = error.expect_err("no such key").to_string();
//! assert_eq!(message, "valley.toml:8: diamond-square: unknown key `releif`; did you mean `relief`?");
//! # Ok::<(), weald::Error>(())
//! ```
//!
//! Without a recipe, a program opens or makes a [`Landscape`], runs [`steps`] on it, paints and saves:
//!
//! ```
//! use weald::prelude::{Landscape, LandscapeExt, steps};
//!
//! let mut landscape = Landscape::empty(48, 32, 20.0)?; // columns, rows, metres
//! landscape.run_with(&steps::DiamondSquare { relief: 200.0, ..Default::default() }, 7)?;
//! landscape.run(&steps::Hydraulic { iterations: 120, ..Default::default() })?;
//! let (_, deepest) = landscape.field("erosion")?.range(None).expect("there are cells");
//! assert!(deepest > 0.01 && deepest < 200.0, "rain has carved up to {deepest} m");
//! # Ok::<(), weald::Error>(())
//! ```
//!
//! Where to go on:
//!
//! * [`prelude`]: the few names of such a program; `examples/` has five programs.
//! * [`recipe`]: what a recipe can say, how it is checked and run; [`recipe::catalog`] lists all steps.
//! * [`generate`], [`combine`], [`erode`]: the steps, one file a method, each with its equation and source.
//! * [`Landscape`], [`Domain`], [`Field`]: layers on a grid with a cell size, georeferencing, a no-data mask.
//! * [`material`]: what ground is made of, in layers; [`edit`]: brushes, scripts of strokes, undo and redo.
//! * [`recipe::Session`]: a step of a recipe that a person holds, painted on, undone and saved as a recipe;
//!   [`erode::interactive`]: the same without a recipe, for an editor of your own.
//! * [`step::Step`]: what a step declares and does. [`LandscapeExt::run`] runs one, and [`engine::Job`] watches it.
//! * [`analyse`]: slope, flow, rivers, light, soil and other layers, and measures of river networks.
//! * [`grow`]: plants, and where they stand.
//! * [`io`]: raster formats. [`picture`]: maps and views. [`export`]: meshes, vectors, sets for engines, pages.
//!
//! Row 0 is north, `x` counts columns eastward and `y` rows southward. Heights and lengths are in metres unless
//! a name says otherwise, angles in degrees carry the suffix `_deg`. [`Error`] is sorted by who must act.

mod file_rows;
mod ground_file;
mod landscape_ext;
mod layer_raster;
pub mod prelude;
pub mod recipe;
pub mod steps;
mod written;

pub use landscape_ext::LandscapeExt;

#[doc(inline)]
pub use weald_core::{
    attachment, condition, domain, error, files, grid, landscape, layer_words, material, parameter, plants,
    random, sea, strata, vectors,
};
#[doc(inline)]
pub use weald_core::{choices, parameters, variants};
#[doc(inline)]
pub use weald_engine as engine;
#[doc(inline)]
pub use weald_engine::{stencil, step};
#[doc(inline)]
pub use weald_export as export;
#[doc(inline)]
pub use weald_io as io;
#[doc(inline)]
pub use weald_land::{analyse, combine, edit, erode, flow, generate};
#[doc(inline)]
pub use weald_picture as picture;
#[doc(inline)]
pub use weald_plants as grow;

pub use weald_core::{Domain, Error, Field, Landscape, Size};
