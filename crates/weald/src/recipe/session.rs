//! A session: a step of a recipe that a person holds, with what came before it and what comes after.
//!
//! [`Session::open`] runs the steps before the one that is held. What is then done, steps, strokes and settings, can be
//! undone and redone along branches, and [`Session::save`] writes it as a recipe with a script of edits, which `weald run`
//! replays to the same bits on the same engine, and which opens again as a session.

mod saved;

use std::path::Path;
use std::sync::Arc;

use super::cache::{Cache, KeptSteps};
use super::parameter::Diagnostics;
use super::plan::{Planned, Recipe};
use super::run::Progress;
use super::run_to::{self, start};
use super::source::Value;
use weald_core::error::{Error, RecipeError};
use weald_core::landscape::Landscape;
use weald_core::sea;
use weald_engine::Engine;
use weald_engine::step::Outcome;
use weald_land::edit::{Action, Area, Brush, Canvas, Change, Edit, History, Layout, Setting};
use weald_land::erode::interactive::{Interactive, InteractiveSimulation};
use weald_land::erode::{interactive_names, interactive_step};

/// How a session is opened.
#[derive(Clone, Debug)]
pub struct SessionOptions {
    /// Where simulations run.
    pub engine: Engine,
    /// Number of the step to hold, counted from 1; the last one that can be held where none is given.
    pub step: Option<usize>,
    /// Most bytes that are kept to go back with, on a device there.
    pub memory: u64,
    /// Results of steps that earlier sessions and runs have left, and that this one leaves.
    pub cache: Option<Arc<Cache>>,
}

impl Default for SessionOptions {
    /// The CPU, the last step that can be held, and a gigabyte.
    fn default() -> Self {
        Self { engine: Engine::Cpu, step: None, memory: 1 << 30, cache: None }
    }
}

/// A step of a recipe that runs under a person's hands.
#[derive(Debug)]
pub struct Session {
    recipe: Recipe,
    /// Place of the step that is held, counted from 0.
    held: usize,
    step: Box<dyn Interactive>,
    history: History<InteractiveSimulation>,
    engine: Engine,
    /// What the layers on which the step began follow from.
    before: Option<KeptSteps>,
}

impl Session {
    /// Runs the steps before the one that is held. A step that has a script of edits is brought to its end, as it was
    /// saved; any other is at its beginning.
    ///
    /// # Errors
    /// [`Error::Run`] where the recipe has no step that can be held, [`Error::Limit`] where the memory does not hold the
    /// start, and those of a run.
    pub fn open(recipe: Recipe, options: SessionOptions, progress: &dyn Progress) -> Result<Self, Error> {
        let SessionOptions { engine, step, memory, cache } = options;
        let (held, step) = held(&recipe, step)?;
        let mut landscape = start(&recipe, progress)?;
        let kept = cache.as_ref().map(|cache| KeptSteps::new(cache, &recipe, (&landscape, &engine)));
        let mut before = kept.transpose()?;
        for (number, planned) in recipe.steps[..held].iter().enumerate() {
            progress.step(number + 1, recipe.steps.len(), planned.entry.name);
            run_to::step((&recipe, planned), &mut landscape, (&engine, before.as_mut()), progress)?;
        }
        step.look_ahead(&landscape.materials, &landscape.domain)?;
        let history = History::new(step.hold(&landscape, &engine)?, memory)?;
        let recorded = step.recorded(&landscape.materials)?;
        let mut session = Self { recipe, held, step, history, engine, before };
        if let Some((steps, script)) = recorded {
            session.replay(steps, script.edits())?;
        }
        Ok(session)
    }

    /// Takes a recipe that is the same up to the step that is held, so that only what comes after it is another; the
    /// simulation goes on as it is. `false`, and nothing has changed, for a recipe that differs before.
    pub fn adopt(&mut self, recipe: Recipe) -> bool {
        let is_same = self.recipe.begins_as(&recipe, self.held + 1);
        if is_same {
            self.recipe = recipe;
        }
        is_same
    }

    fn replay(&mut self, steps: u64, edits: &[Edit]) -> Result<(), Error> {
        for edit in edits.iter().filter(|edit| edit.step <= steps) {
            self.advance(edit.step - self.steps())?;
            self.history.act(edit.change.clone())?;
        }
        self.advance(steps - self.steps())
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.history.simulation().steps()
    }

    /// Steps that the one that is held runs as the recipe has it.
    pub fn written_steps(&self) -> u64 {
        self.step.written_steps(self.history.simulation().start())
    }

    /// Place of the step that is held among those that run, counted from 0.
    pub fn place_among_running(&self) -> usize {
        self.held
    }

    /// Place of the table of the step that is held.
    fn place(&self) -> usize {
        self.recipe.steps[self.held].place
    }

    /// The place of the step that is held among all `[[step]]` tables, counted from 0, and the keys with which it runs to here; a script of what was
    /// done goes with them under the key `edits`.
    pub fn replayed(&self) -> (usize, Vec<(&'static str, Value)>) {
        (self.place(), self.step.replayed(self.steps()))
    }

    /// Simulates so many steps.
    ///
    /// # Errors
    /// [`Error::NotFinite`] where values become no numbers; the session is then as it was.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        if steps > 0 {
            self.history.act(Action::Steps(steps))?;
        }
        Ok(())
    }

    /// Paints a stroke.
    ///
    /// # Errors
    /// [`Error::Run`] for a stroke that the step cannot follow; nothing has changed then.
    pub fn paint(&mut self, brush: Brush) -> Result<(), Error> {
        self.history.act(Change::Stroke(brush)).map(drop)
    }

    /// Gives a key of the step another value from here on.
    ///
    /// # Errors
    /// [`Error::Run`] for a key or a value that there is not; nothing has changed then.
    pub fn set(&mut self, setting: Setting) -> Result<(), Error> {
        self.history.act(Change::Set(setting)).map(drop)
    }

    /// All that was done, to go back and forth in it.
    pub fn history(&mut self) -> &mut History<InteractiveSimulation> {
        &mut self.history
    }

    /// The state over a rectangle of cells, in metres; no more is read from a device.
    ///
    /// # Errors
    /// [`Error::Run`] where the rectangle is not within the landscape, [`Error::Device`] where the device fails.
    pub fn patch(&mut self, area: Area) -> Result<Canvas, Error> {
        self.history.simulation_mut().canvas(area)
    }

    /// The landscape as it is now, as if the step had ended here, with what the step would report.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn landscape(&mut self) -> Result<(Landscape, Outcome), Error> {
        let (mut landscape, outcome) = self.history.simulation_mut().landscape()?;
        sea::stand(&mut landscape)?;
        Ok((landscape, outcome))
    }

    /// The landscape after the steps that come after this one.
    ///
    /// # Errors
    /// Those of the steps.
    pub fn finish(&mut self, progress: &dyn Progress) -> Result<Landscape, Error> {
        let (mut landscape, _) = self.landscape()?;
        let mut kept = self.before.clone();
        if let Some(kept) = &mut kept {
            let (steps, script) = self.history.script();
            let start = self.history.simulation().start();
            kept.held(
                &self.recipe.steps[self.held],
                (start, &landscape),
                &format!("{steps}\n{}", script.text(Layout::JsonLines)),
            );
        }
        for (number, planned) in self.recipe.steps.iter().enumerate().skip(self.held + 1) {
            progress.step(number + 1, self.recipe.steps.len(), planned.entry.name);
            run_to::step((&self.recipe, planned), &mut landscape, (&self.engine, kept.as_mut()), progress)?;
        }
        Ok(landscape)
    }

    /// Writes the session as a recipe, and the script of what was done beside it: `name.toml` and `name.edits.jsonl`. The
    /// script is written first, so that there is no recipe without one.
    ///
    /// # Errors
    /// [`Error::Run`] where a file cannot be written, or more steps were done than a recipe can ask for.
    pub fn save(&self, file: &Path) -> Result<(), Error> {
        let (steps, script) = self.history.script();
        saved::write(&self.recipe, (self.place(), &*self.step), (steps, &script), file)
    }
}

/// The step that is held, with its place.
fn held(recipe: &Recipe, wanted: Option<usize>) -> Result<(usize, Box<dyn Interactive>), Error> {
    let names = interactive_names();
    let can = |planned: &Planned| names.contains(&planned.entry.name);
    let place = match wanted {
        Some(number) => number.checked_sub(1).filter(|at| recipe.steps.get(*at).is_some_and(can)),
        None => recipe.steps.iter().rposition(can),
    };
    let Some(place) = place else {
        let which = wanted.map_or("no step".to_owned(), |number| format!("no step {number}"));
        let message = format!("{} has {which} that can be held; such are: {}", recipe.file, names.join(", "));
        return Err(Error::Run(message));
    };
    let (planned, mut diagnostics) = (&recipe.steps[place], Diagnostics::default());
    let step = interactive_step(planned.entry.name, &planned.keys, &mut diagnostics);
    match step.filter(|_| diagnostics.found.is_empty()) {
        Some(step) => Ok((place, step)),
        None => Err(RecipeError { file: recipe.file.clone(), diagnostics: diagnostics.found }.into()),
    }
}
