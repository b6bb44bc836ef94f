//! How a simulation ended.

use super::sums;
use weald_engine::stencil::chain::RowSums;
use weald_engine::stencil::rows::Rows;

/// How a simulation ended.
pub(crate) struct Finished {
    pub(crate) state: Rows,
    pub(crate) sums: RowSums,
    /// One mean a wish, row-major.
    pub(crate) means: Vec<Vec<f32>>,
    /// What the user should know of the engine.
    pub(crate) notes: Vec<String>,
}

/// The sums of a run as water in and out and solid out, in cells³.
pub(crate) struct Flows {
    pub(crate) rained: f64,
    pub(crate) water_out: f64,
    pub(crate) solid_out: f64,
}

impl From<RowSums> for Flows {
    fn from(row: RowSums) -> Self {
        Self {
            rained: row[sums::RAINED],
            water_out: row[sums::WATER_OUT] - row[sums::EVAPORATED],
            solid_out: row[sums::SEDIMENT_OUT] + row[sums::SHRUNK],
        }
    }
}
