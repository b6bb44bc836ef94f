//! Reading the land: layers of what its shape means for water, light and plants, and measures of ground and water.
//!
//! What is measured is a function of fields and masks first, and a step of a recipe second. Each step of
//! [`Stage::Analyse`](weald_engine::step::Stage::Analyse) stands in a file of its name and says unit and range of what it
//! writes.

mod angle;
pub mod aspect;
mod cells;
pub mod contour;
pub mod curvature;
pub mod flow_step;
mod gaussian;
mod horizon;
pub mod lakes;
mod latitude;
pub mod moisture;
pub mod network;
pub mod network_step;
pub mod occlusion;
mod quadric;
pub mod rivers;
pub mod select;
mod sky;
pub mod slope;
pub mod soil;
mod stages;
pub mod stream_azimuths;
mod sun;
pub mod sunlight;
pub mod watersheds;
pub mod wetness;
mod window_rows;

pub use crate::flow::directions;

use rayon::prelude::*;

use weald_core::error::{Error, NotFinite};
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;

/// Cells a task works on; no result depends on it.
const CELLS_PER_TASK: usize = 1 << 14;

/// Refuses a layer that holds a NaN or an infinity in a cell with data.
fn ensure_finite(landscape: &Landscape, name: &str) -> Result<(), Error> {
    let domain = &landscape.domain;
    let Some((x, y)) = landscape.field(name)?.first_not_finite(domain.valid.as_ref()) else { return Ok(()) };
    let message = format!(
        "the layer `{name}` is not a finite number in column {x}, row {y}; mend it, or mark the cell as no-data"
    );
    Err(NotFinite { step: None, iteration: None, layer: name.to_owned(), cell: [x, y], message }.into())
}

/// Sums of each cell as a layer, in another unit.
fn scaled<T: Copy + Into<f64> + Sync>(size: Size, sums: &[T], unit: f64) -> Field {
    let values = sums.par_iter().with_min_len(CELLS_PER_TASK).map(|&sum| (sum.into() * unit) as f32);
    Field::from_values(size, values.collect())
}
