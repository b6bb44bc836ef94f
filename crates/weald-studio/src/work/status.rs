//! What the thread that works shows to the window.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use weald::edit::Canvas;
use weald::{Field, Landscape};

use crate::state::State;

/// What the thread is at.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Phase {
    /// Nothing.
    #[default]
    Idle,
    /// A step of a recipe.
    Running {
        /// Number of the step, counted from 1.
        step: usize,
        /// Steps of the recipe.
        count: usize,
        /// What it does.
        name: String,
        /// Share of it that is done, where it tells.
        share: Option<f32>,
    },
    /// The simulation that is held.
    Simulating,
    /// Files.
    Writing(String),
}

/// A stretch of what was done: one stroke, one setting, or steps one after the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Number in the history.
    pub number: usize,
    /// Steps done by then.
    pub steps: u64,
    /// What led to it.
    pub label: String,
    /// Whether steps did.
    pub is_steps: bool,
    /// Whether it lies before now, on the way that led here.
    pub is_past: bool,
}

/// A landscape to be drawn.
#[derive(Clone, Debug)]
pub struct Shown {
    /// All its layers.
    pub landscape: Arc<Landscape>,
    /// Elevation of its lowest ground, from which the heights of pictures count.
    pub lowest: f32,
    /// Changes with every other landscape.
    pub number: u64,
    /// Revision of the document that it was made of.
    pub revision: u64,
    /// Steps of the recipe that it comes after.
    pub steps: usize,
    /// How much was done by hand when it was made: [`Status::changes`].
    pub changes: u64,
    /// Name and text of the recipe that made it.
    pub recipe: Arc<(String, String)>,
}

/// Ground and water of a simulation as it runs.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Elevation of the ground, in metres.
    pub ground: Arc<Field>,
    /// All that a brush can change, the water among it.
    pub canvas: Arc<Canvas>,
    /// Grows with every change.
    pub number: u64,
    /// The landscape on which it lies: [`Shown::number`].
    pub shown: u64,
}

/// Landscapes of several seeds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seeds {
    /// Another one each time that some are asked for.
    pub number: u64,
    /// Where their pictures are.
    pub folder: PathBuf,
    /// How many are asked for.
    pub count: u64,
    /// Seeds that are done, with their pictures, or with what went wrong.
    pub done: Vec<(u64, Result<PathBuf, String>)>,
    /// All pictures on one sheet, once all are done.
    pub sheet: Option<PathBuf>,
    /// Whether more are to come.
    pub runs: bool,
}

/// All that the window can know of the work.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Status {
    /// What it is at.
    pub phase: Phase,
    /// Revision of the document that was opened last, whole or not.
    pub revision: u64,
    /// Number of the last task that was done or refused, counted from 1 in the order of asking.
    pub done: u64,
    /// What went wrong last, until something else is asked.
    pub error: Option<String>,
    /// What the user should know.
    pub notes: Vec<String>,
    /// The landscape.
    #[serde(skip)]
    pub shown: Option<Shown>,
    /// What has changed on it since.
    #[serde(skip)]
    pub surface: Option<Surface>,
    /// Place of the step that is held, counted from 0.
    pub held: Option<usize>,
    /// Names of the materials that brushes add to the ground that is held, bedrock first.
    pub materials: Vec<String>,
    /// Whether the simulation runs.
    pub plays: bool,
    /// Steps done.
    pub steps: u64,
    /// Steps that the recipe asks for.
    pub written_steps: u64,
    /// Where simulations run: an adapter, or the processor, and why there where a device could be expected.
    pub engine: String,
    /// Steps a second, as of late.
    pub pace: f64,
    /// What was done, oldest first, and what was taken back.
    pub moments: Vec<Moment>,
    /// Names of moments.
    pub names: Vec<(String, usize)>,
    /// Bytes that are kept to go back with.
    pub kept: u64,
    /// How often something was done by hand, so that the window knows what is not yet saved.
    pub changes: u64,
    /// How many strokes, settings and steps that were asked could not be done, and left nothing to undo.
    pub refused: u64,
    /// The file that was saved last, of which text of the document and at which of the changes; none of this project yet.
    pub saved: Option<(PathBuf, State)>,
    /// The same of what was written in case that the program is killed.
    pub autosaved: Option<(PathBuf, State)>,
    /// Landscapes of several seeds, where such were asked for.
    pub seeds: Option<Seeds>,
    /// What was exported last.
    pub exported: Option<(PathBuf, Vec<String>)>,
}
