//! A script that happens to a simulation: strokes on its state, and keys of the step that change while it runs.

use std::sync::Arc;

use super::edits::{Place, stills};
use super::painted_mask::PaintedMask;
use crate::edit::{Brush, Change, Edit, Effect, Script, Setting};
use weald_core::error::Error;
use weald_core::material::Material;
use weald_core::parameter::ScriptFile;
use weald_engine::machine::Snapshot;
use weald_engine::patch::Patched;
use weald_engine::stencil::chain::Process;

/// Weather of each step.
pub(crate) type Weather<P> = Arc<dyn Fn(u64) -> <P as Process>::Weather + Send + Sync>;

/// What the keys of a step say to a simulation that runs.
pub(crate) struct Numbers<P: Process> {
    pub(crate) process: Arc<P>,
    pub(crate) weather: Weather<P>,
}

impl<P: Process> Numbers<P> {
    pub(crate) fn new(process: P, weather: impl Fn(u64) -> P::Weather + Send + Sync + 'static) -> Self {
        Self { process: Arc::new(process), weather: Arc::new(weather) }
    }
}

impl<P: Process> Clone for Numbers<P> {
    fn clone(&self) -> Self {
        Self { process: Arc::clone(&self.process), weather: Arc::clone(&self.weather) }
    }
}

/// Reads all keys anew with some of them set to other values, one after the other.
pub(crate) type Remake<P> = Arc<dyn Fn(&[Setting]) -> Result<Numbers<P>, Error> + Send + Sync>;

/// A script, and what it works on.
pub(crate) struct Edits<P: Process> {
    pub(crate) script: Script,
    pub(crate) place: Option<Arc<Place>>,
    pub(crate) remake: Remake<P>,
}

impl<P: Process> Edits<P> {
    /// The first step, from `step` on, before which something happens.
    pub(crate) fn next_from(&self, step: u64) -> Option<u64> {
        self.script.next_from(step)
    }

    /// The keys that were set before a step, in order.
    pub(crate) fn settings_before(&self, step: u64) -> Vec<Setting> {
        let earlier = self.script.edits().iter().filter(|edit| edit.step < step);
        earlier.filter_map(|edit| edit.setting().cloned()).collect()
    }

    /// The keys that are set at a step and later, in order.
    pub(crate) fn settings_from(&self, step: u64) -> Vec<Setting> {
        let later = self.script.edits().iter().filter(|edit| edit.step >= step);
        later.filter_map(|edit| edit.setting().cloned()).collect()
    }

    /// The numbers after these keys were set.
    pub(crate) fn numbers(&self, settings: &[Setting], first: &Numbers<P>) -> Result<Numbers<P>, Error> {
        if settings.is_empty() { Ok(first.clone()) } else { (self.remake)(settings) }
    }

    /// Where strokes fall.
    pub(crate) fn place(&self) -> Result<&Place, Error> {
        self.place.as_deref().ok_or_else(nothing_to_paint_on)
    }

    /// What the user should know after a run of so many steps.
    pub(crate) fn notes(&self, iterations: u64) -> Vec<String> {
        let edits = self.script.edits();
        let (happened, late) = edits.split_at(edits.partition_point(|edit| edit.step <= iterations));
        let strokes: Vec<_> = happened.iter().filter_map(Edit::brush).collect();
        let touches = |brush: &&&Brush| self.place.as_ref().is_none_or(|place| place.is_touched_by(brush));
        let beside = strokes.len() - strokes.iter().filter(touches).count();
        let mut notes = Vec::new();
        if !strokes.is_empty() {
            notes.push(format!(
                "strokes of the script that happened: {}; in the budget the ground that they gave or took counts as \
                 solid that went out (below 0: came), the water as rain and evaporation",
                strokes.len()
            ));
        }
        if strokes.len() < happened.len() {
            notes.push(format!("keys that the script set: {}", happened.len() - strokes.len()));
        }
        if beside > 0 {
            notes.push(format!("strokes that touched no cell of the landscape: {beside}"));
        }
        if !late.is_empty() {
            let late = late.len();
            notes.push(format!(
                "edits that did not happen, since they come after the last of {iterations} iterations: {late}"
            ));
        }
        notes
    }

    /// Paints the weather, the mask, and what stands still, again as they were after `done` steps: a checkpoint does not
    /// hold them.
    pub(crate) fn catch_up(&self, done: u64, snapshot: &mut Snapshot) -> Result<(), Error> {
        let mut mask = PaintedMask::default();
        let weather = |effect: &Effect| {
            matches!(effect, Effect::Source { .. } | Effect::Drain { .. } | Effect::Rain { .. })
        };
        let stays = |brush: &&Brush| weather(&brush.effect) || stills(&brush.effect) || brush.effect.masks();
        let earlier = self.script.edits().iter().filter(|edit| edit.step < done);
        let state: &mut dyn Patched = snapshot;
        for brush in earlier.filter_map(Edit::brush).filter(stays) {
            self.place()?.stroke(brush, state, &mut mask)?;
        }
        Ok(())
    }

    /// The mask as it was painted before a step.
    pub(crate) fn mask_before(&self, step: u64) -> Result<PaintedMask, Error> {
        let mut mask = PaintedMask::default();
        let earlier = self.script.edits().iter().filter(|edit| edit.step < step);
        for brush in earlier.filter_map(Edit::brush).filter(|brush| brush.effect.masks()) {
            self.place()?.paint_mask(brush, &mut mask)?;
        }
        Ok(mask)
    }
}

/// A stroke for a process without ground.
pub(crate) fn nothing_to_paint_on() -> Error {
    Error::Run("this step has no ground that could be painted on; it follows settings alone".to_owned())
}

/// Reads the script of a step and checks it, where there is one.
pub(super) fn load(
    file: Option<&ScriptFile>,
    open: bool,
    materials: &[Material],
    try_keys: impl Fn(&[Setting]) -> Result<(), Error>,
) -> Result<Option<Script>, Error> {
    let Some(path) = file.map(ScriptFile::path) else { return Ok(None) };
    let names: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
    let script = Script::load(&path, &names)?;
    check(&script, open, try_keys).map_err(|what| Error::input(&path, what))?;
    Ok(Some(script))
}

/// Complains of the first edit that a step cannot follow: `try_key` reads the step anew with keys that are set.
fn check(
    script: &Script,
    open: bool,
    try_keys: impl Fn(&[Setting]) -> Result<(), Error>,
) -> Result<(), String> {
    let mut settings = Vec::new();
    for Edit { step, change } in script.edits() {
        let checked = match change {
            Change::Stroke(brush) => super::edits::check_stroke(brush, open),
            Change::Set(setting) => {
                settings.push(setting.clone());
                try_keys(&settings).map_err(|error| error.to_string())
            }
        };
        checked.map_err(|what| format!("before step {step} {what}"))?;
    }
    Ok(())
}
