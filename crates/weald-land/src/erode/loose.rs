//! What processes without weather have in common as steps: a number of iterations, and a script of edits.

use std::path::PathBuf;

use super::interactive::{Interactive, InteractiveSimulation, whole};
use super::started::{Course, StartedSimulation};
use super::{scripted, settings};
use crate::edit::{Script, Setting};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Parameters, ScriptFile};
use weald_core::source::Value;
use weald_engine::stencil::chain::Process;
use weald_engine::step::{Outcome, Step};
use weald_engine::{Engine, Job};

/// A process without weather as a step.
pub(super) trait Loose: Step + Parameters + Clone {
    type Process: Process;

    /// Keys of what it begins with, beside `iterations` and `edits`.
    const FIXED: &'static [&'static str];

    /// The simulation before its first iteration, such that strokes can change it where it is `editable`.
    fn begin(&self, landscape: &Landscape, editable: bool)
    -> Result<StartedSimulation<Self::Process>, Error>;

    /// Iterations to run.
    fn iterations(&self) -> u32;

    /// Its script of edits.
    fn edits(&self) -> Option<&ScriptFile>;
}

/// Runs the step to its end.
pub(super) fn run<L: Loose>(step: &L, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
    let course = Course::of(step.iterations(), script(step, &landscape.materials)?);
    step.begin(landscape, step.edits().is_some())?.run(course, landscape, job)
}

/// The step after keys were set while it ran.
pub(super) fn after<L: Loose>(step: &L, settings: &[Setting]) -> Result<L, Error> {
    let fixed: Vec<_> = L::FIXED.iter().copied().chain(["iterations", "edits"]).collect();
    settings::after(step, (&[], &fixed), settings)
}

/// The script of edits, which is read here.
pub(super) fn script<L: Loose>(step: &L, materials: &[Material]) -> Result<Option<Script>, Error> {
    let try_keys = |settings: &[Setting]| settings::no_faults(&after(step, settings)?, materials);
    scripted::load(step.edits(), false, materials, try_keys)
}

/// Files that the step reads.
pub(super) fn files(step: &impl Loose) -> Vec<PathBuf> {
    step.edits().map(ScriptFile::path).into_iter().collect()
}

impl<L: Loose> Interactive for L {
    fn hold(&self, landscape: &Landscape, engine: &Engine) -> Result<InteractiveSimulation, Error> {
        InteractiveSimulation::new(self.begin(landscape, true)?, landscape, engine)
    }

    fn replayed(&self, steps: u64) -> Vec<(&'static str, Value)> {
        vec![("iterations", whole(steps))]
    }

    fn written_steps(&self, _: &Landscape) -> u64 {
        u64::from(self.iterations())
    }

    fn recorded(&self, materials: &[Material]) -> Result<Option<(u64, Script)>, Error> {
        Ok(script(self, materials)?.map(|script| (u64::from(self.iterations()), script)))
    }
}
