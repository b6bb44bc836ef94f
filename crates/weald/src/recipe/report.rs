//! `report.json`: what a run did, how fast, and where water and solid went.

use std::path::Path;

use serde::{Deserialize, Serialize};

use weald_core::error::Error;
use weald_core::files;
use weald_engine::report::StepReport;
use weald_io::write_whole;

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

/// A file that was written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OutputReport {
    /// Path inside the output folder, as the recipe has it.
    pub file: String,
    /// Time it took. Outputs are made side by side, so that all of them take less than the sum.
    #[serde(default)]
    pub seconds: f64,
    /// Most memory in bytes that the process had taken by its end, where the system tells it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub peak_memory: Option<u64>,
    /// Whether no file has that name, but only its numbered frames or its tiles have theirs from it.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub name_only: bool,
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

impl Report {
    /// Reads the report of a run that is done.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is missing or is no report.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let unread = |cause: &dyn std::fmt::Display| Error::input(path, format!("cannot be read: {cause}"));
        let text = files::read(path).map_err(|cause| unread(&cause))?;
        serde_json::from_slice(&text).map_err(|cause| unread(&cause))
    }

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
