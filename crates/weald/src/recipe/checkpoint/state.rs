//! What a checkpoint keeps.

use weald_core::landscape::Landscape;
use weald_engine::SavedSimulation;
use weald_engine::report::StepReport;

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::recipe) struct State {
    /// The landscape as it was before the step that runs now.
    pub(in crate::recipe) landscape: Landscape,
    /// Steps done.
    pub(in crate::recipe) done: usize,
    /// Where the step that runs now is, if it can go on from there.
    pub(in crate::recipe) simulation: Option<SavedSimulation>,
    /// What the steps done have to report.
    pub(in crate::recipe) steps: Vec<StepReport>,
    /// What there is to say of the input.
    pub(in crate::recipe) notes: Vec<String>,
}
