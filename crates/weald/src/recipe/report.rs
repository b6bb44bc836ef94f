//! `report.json`: what a run did, how fast, and where water and solid went.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::engine::{Budget, SolidBudget, WaterBudget};
use crate::error::Error;
use crate::io::write_whole;

/// Name of the report in the output folder.
pub const REPORT_FILE: &str = "report.json";

/// What a run did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Where simulations ran.
    pub engine: String,
    /// The graphics adapter, for an engine that uses one.
    pub adapter: Option<String>,
    /// Seed of the landscape.
    pub seed: u64,
    /// Hash of the recipe after overrides.
    pub recipe_blake3: String,
    /// Version of Weald.
    pub version: String,
    /// All steps in order.
    pub steps: Vec<StepReport>,
    /// All files in order.
    pub outputs: Vec<OutputReport>,
    /// What the user should know of the input.
    pub notes: Vec<String>,
}

/// What one step did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// Its name.
    pub step: String,
    /// Time it took.
    pub seconds: f64,
    /// Cells of the grid.
    pub cells: usize,
    /// What the step counts: simulation steps, faults, octaves.
    pub iterations: u64,
    /// Cells times iterations, a second.
    pub cell_updates_per_second: f64,
    /// Where water and solid went, for simulations.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub budget: Option<BudgetReport>,
    /// What was measured, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub measures: BTreeMap<String, f64>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// A file that was written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OutputReport {
    /// Path inside the output folder.
    pub file: String,
    /// The layer in it, unless it is a picture.
    pub layer: Option<String>,
    /// The kind of picture, if it is one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub picture: Option<String>,
    /// The kind of export, if it is one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub export: Option<String>,
    /// What drew a picture that a device draws, of which no two give the same bits.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub adapter: Option<String>,
    /// Pictures of a film, numbered from 0.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub frames: Option<u64>,
    /// Files beside it that belong to it.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub companions: Vec<String>,
    /// Unit of the layer.
    pub unit: Option<String>,
    /// Least and greatest value of the layer over the cells with data.
    pub range: Option<(f64, f64)>,
    /// What the user should know, such as what the format cannot hold.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub notes: Vec<String>,
}

/// Water and solid in cubic metres; errors are relative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BudgetReport {
    /// Water.
    pub water: WaterReport,
    /// Ground and sediment.
    pub solid: SolidReport,
}

/// Water in cubic metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WaterReport {
    /// Rained, and standing at the start.
    #[serde(rename = "in")]
    pub incoming: f64,
    /// Evaporated, and run over an open edge.
    #[serde(rename = "out")]
    pub outgoing: f64,
    /// Standing at the end.
    pub stored: f64,
    /// What is missing, relative to what came in.
    pub error: f64,
}

/// Solid in cubic metres above the lowest ground of the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidReport {
    /// Ground at the start.
    pub start: f64,
    /// Ground at the end.
    pub bedrock: f64,
    /// Loose layers and regolith at the end; 0 where the step does not keep them apart from the ground.
    pub layers: f64,
    /// Carried by water at the end.
    pub suspended: f64,
    /// Carried over an open edge.
    #[serde(rename = "out")]
    pub outgoing: f64,
    /// What is missing, relative to the start.
    pub error: f64,
}

impl Report {
    /// Writes the report as JSON.
    ///
    /// # Errors
    /// [`Error::Run`] where the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut text = serde_json::to_string_pretty(self).expect("numbers, texts and lists are JSON");
        text.push('\n');
        write_whole(path, text.as_bytes())
    }
}

impl From<Budget> for BudgetReport {
    fn from(Budget { water, solid }: Budget) -> Self {
        Self { water: water.into(), solid: solid.into() }
    }
}

impl From<WaterBudget> for WaterReport {
    fn from(water: WaterBudget) -> Self {
        let WaterBudget { incoming, outgoing, stored } = water;
        Self { incoming, outgoing, stored, error: water.error() }
    }
}

impl From<SolidBudget> for SolidReport {
    fn from(solid: SolidBudget) -> Self {
        let SolidBudget { start, ground, layers, suspended, outgoing } = solid;
        Self { start, bedrock: ground, layers, suspended, outgoing, error: solid.error() }
    }
}
