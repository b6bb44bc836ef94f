//! What a step did, as it stands in `report.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::budget::{Budget, SolidBudget, WaterBudget};

/// What one step did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// Its name.
    pub step: String,
    /// Time it took.
    pub seconds: f64,
    /// Most memory in bytes that the process had taken by its end, where the system tells it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub peak_memory: Option<u64>,
    /// Whether its result was kept from an earlier run: `seconds` are then those of fetching it.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub cached: bool,
    /// Cells of the grid.
    pub cells: usize,
    /// What the step counts: iterations, faults, octaves.
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
    /// Raised by uplift.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub uplifted: f64,
    /// Ground at the end.
    pub bedrock: f64,
    /// Loose layers and regolith at the end; 0 where the step does not keep them apart from the ground.
    pub layers: f64,
    /// Carried by water at the end.
    pub suspended: f64,
    /// Carried over an open edge.
    #[serde(rename = "out")]
    pub outgoing: f64,
    /// All that cells gained or lost, carry or let go.
    #[serde(default)]
    pub moved: f64,
    /// What is missing, relative to the start or to what moved, whichever is more.
    pub error: f64,
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
        let SolidBudget { start, uplifted, ground, layers, suspended, outgoing, moved } = solid;
        Self { start, uplifted, bedrock: ground, layers, suspended, outgoing, moved, error: solid.error() }
    }
}

/// What most steps have nothing of is left out.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")] // On 32 bits it is not so small.
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
