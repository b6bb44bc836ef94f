//! The one who works: does what is asked, one task after the other, and lets the simulation run in short slices between them.

mod batch;
mod opening;
mod seeds;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use weald::Error;
use weald::files;
use weald::recipe::{Cache, Options, Overrides, Progress, Recipe, Run};
use web_time::Instant;

use super::held::HeldSession;
use super::shared::{Shared, Told};
use super::status::{Phase, Surface};
use super::task::{Opening, Task};
use crate::presets::with_outputs;
use crate::state::State;
use batch::Batch;

/// How long the simulation runs between two looks at what is asked.
const SLICE: Duration = Duration::from_millis(20);

/// Least time between two surfaces while it runs: what a window can draw.
const SURFACE_EVERY: Duration = Duration::from_millis(60);

/// Least time between two lists of what was done, while it runs.
const MOMENTS_EVERY: Duration = Duration::from_millis(250);

/// How long nothing is asked before the steps after the one that is held run.
const REST: Duration = Duration::from_millis(400);

/// Bytes of results that are kept in memory, so that a change runs again from the changed step only.
const CACHE_BYTES: u64 = 1 << 30;

/// How long there is nothing to do, as long as nothing is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rest {
    /// There is something to do.
    None,
    /// So long.
    For(Duration),
    /// Until something is asked.
    UntilAsked,
}

pub(super) struct Worker {
    waiting: VecDeque<(u64, Task)>,
    shared: Arc<Shared>,
    cache: Arc<Cache>,
    opening: Option<Opening>,
    held: Option<HeldSession>,
    /// Steps at which a simulation that runs stands still.
    until: Option<u64>,
    /// Steps that fill a slice.
    slice: u64,
    surfaced: Instant,
    /// How long the device took to hand a surface over, as of late.
    handed_over: Duration,
    moments_told: Instant,
    /// Whether the steps after the one that is held have run since it changed.
    is_finished: bool,
    /// Number of the last stroke of the hand, done or refused.
    stroke: u64,
    batch: Option<Batch>,
    /// Why no device simulates, where one could be expected to.
    without_device: Option<String>,
}

impl Worker {
    pub(super) fn new(shared: Arc<Shared>) -> Self {
        Self {
            waiting: VecDeque::new(),
            shared,
            cache: Arc::new(Cache::in_memory(CACHE_BYTES)),
            opening: None,
            held: None,
            until: None,
            slice: 1,
            surfaced: Instant::now(),
            handed_over: Duration::ZERO,
            moments_told: Instant::now(),
            is_finished: true,
            stroke: 0,
            batch: None,
            without_device: None,
        }
    }

    /// Says why no device simulates, where one could be expected to.
    pub(super) fn without_device(self, why: Option<String>) -> Self {
        Self { without_device: why, ..self }
    }

    /// Takes a task, to be done after those that it has.
    pub(super) fn ask(&mut self, number: u64, task: Task) {
        self.waiting.push_back((number, task));
    }

    /// How long it has nothing to do.
    pub(super) fn rest(&self) -> Rest {
        let has_seeds = self.is_finished && self.batch.is_some();
        if !self.waiting.is_empty() || self.until.is_some() || has_seeds {
            Rest::None
        } else if self.is_finished {
            Rest::UntilAsked
        } else {
            Rest::For(REST)
        }
    }

    /// Does the next task, or a slice of what is to be done without being asked.
    pub(super) fn work(&mut self) {
        let asked = self.waiting.pop_front();
        let number = asked.as_ref().map(|(number, _)| *number);
        let done = match asked {
            Some((number, task)) => self.take(number, task),
            None if self.until.is_some() => self.simulate(),
            None if self.is_finished && self.batch.is_some() => self.next_seed(),
            None => self.finish(),
        };
        match done {
            Ok(()) | Err(Error::Interrupted(_)) => {}
            Err(error) => {
                self.until = None;
                self.shared.change(|status| status.error = Some(error.to_string()));
            }
        }
        self.show(number);
    }

    fn take(&mut self, number: u64, task: Task) -> Result<(), Error> {
        let _span = tracing::trace_span!("task").entered();
        if let Task::Keep(file) = task {
            return self.autosave(&file);
        }
        self.shared.change(|status| status.error = None);
        match task {
            Task::Open(opening) => return self.open(number, *opening),
            Task::Save(file) => return self.save(&file),
            Task::Export { folder, outputs } => return self.export(number, &folder, outputs.as_deref()),
            Task::Seeds { folder, first, count } => return self.begin_seeds(folder, first, count),
            Task::EndSeeds => {
                self.end_seeds();
                return Ok(());
            }
            Task::Close => {
                self.close();
                return Ok(());
            }
            _ => {}
        }
        if matches!(task, Task::Undo | Task::Redo | Task::GoTo(_)) {
            // Who goes to a moment wants to see it.
            self.until = None;
        }
        let Some(held) = &mut self.held else { return Ok(()) };
        match task {
            Task::Play(plays) => self.until = plays.then_some(u64::MAX),
            Task::PlayToEnd => self.until = Some(held.written_steps()),
            Task::Advance(steps) => held.advance(steps).inspect_err(|_| self.shared.refuse())?,
            Task::Set(setting) => held.set(setting).inspect_err(|_| self.shared.refuse())?,
            Task::Stroke { brush, stroke, replaces } => {
                let begins = std::mem::replace(&mut self.stroke, stroke) != stroke;
                // The window counts a stroke once, however many pieces it comes in.
                held.paint(brush, stroke, replaces).inspect_err(|_| {
                    if begins {
                        self.shared.refuse();
                    }
                })?;
            }
            Task::Undo => drop(held.undo()?),
            Task::Redo => drop(held.redo()?),
            Task::GoTo(moment) => held.go_to(moment)?,
            Task::Name(name) => held.session().history().name(&name),
            Task::Rename { from, to } => drop(held.session().history().rename(&from, &to)),
            Task::Open(_)
            | Task::Save(_)
            | Task::Keep(_)
            | Task::Export { .. }
            | Task::Seeds { .. }
            | Task::EndSeeds
            | Task::Close
            | Task::End => {}
        }
        self.changed()
    }

    /// Forgets what is held: it belongs to another project than what the window shows now.
    fn close(&mut self) {
        (self.held, self.opening, self.until, self.is_finished) = (None, None, None, true);
        self.shared.change(|status| status.materials.clear());
    }

    /// Tells of a change at once.
    fn changed(&mut self) -> Result<(), Error> {
        self.is_finished = false;
        self.shared.status().changes += 1;
        self.surface()
    }

    /// Runs the simulation for a slice of time.
    fn simulate(&mut self) -> Result<(), Error> {
        let (Some(held), Some(until)) = (&mut self.held, self.until) else {
            self.until = None;
            return Ok(());
        };
        let steps = self.slice.min(until.saturating_sub(held.steps()));
        if steps == 0 {
            self.until = None;
            return self.surface();
        }
        let span = tracing::trace_span!("simulation", steps).entered();
        let began = Instant::now();
        held.advance(steps)?;
        drop(span);
        self.is_finished = false;
        let took = began.elapsed();
        let pace = steps as f64 / took.as_secs_f64().max(1e-6);
        // Whatever a device hands over late is asked for seldom: half of the time at least is for steps.
        let slice = SLICE + 2 * self.handed_over;
        self.slice = ((pace * slice.as_secs_f64()) as u64).clamp(1, 4 * steps);
        let mut status = self.shared.status();
        status.pace = if status.pace > 0.0 { 0.9 * status.pace + 0.1 * pace } else { pace };
        status.changes += 1;
        drop(status);
        if self.surfaced.elapsed() >= SURFACE_EVERY { self.surface() } else { Ok(()) }
    }

    /// Shows ground and water as they are.
    fn surface(&mut self) -> Result<(), Error> {
        let _span = tracing::trace_span!("surface").entered();
        let Some(held) = &mut self.held else { return Ok(()) };
        let began = Instant::now();
        let (canvas, ground) = held.surface()?;
        let (canvas, ground) = (Arc::new(canvas), Arc::new(ground));
        self.surfaced = Instant::now();
        let is_on_device = self.opening.as_ref().is_some_and(|opening| opening.engine.adapter().is_some());
        // One that is quick between slow ones says little: others who draw on the device come and go.
        let took = if is_on_device { self.surfaced - began } else { Duration::ZERO };
        self.handed_over = took.max(3 * self.handed_over / 4);
        self.shared.change(|status| {
            let shown = status.shown.as_ref().map_or(0, |shown| shown.number);
            let number = status.surface.as_ref().map_or(1, |surface| surface.number + 1);
            status.surface = Some(Surface { ground, canvas, number, shown });
        });
        Ok(())
    }

    /// Shows the painted mask, which no landscape has, on one that was just published.
    fn show_mask(&mut self) -> Result<(), Error> {
        let Some(held) = &mut self.held else { return Ok(()) };
        let is_masked = held.surface()?.0.mask.values().iter().any(|value| *value > 0.0);
        if is_masked { self.surface() } else { Ok(()) }
    }

    /// Runs the steps after the one that is held, unless something else is asked meanwhile.
    fn finish(&mut self) -> Result<(), Error> {
        if std::mem::replace(&mut self.is_finished, true) {
            return Ok(());
        }
        let _span = tracing::trace_span!("later steps").entered();
        let (Some(held), Some(opening)) = (&mut self.held, &self.opening) else { return Ok(()) };
        let number = self.shared.asked.load(Ordering::Acquire);
        let progress = Told { shared: &self.shared, number, watched: &self.shared.asked };
        let made = match opening.steps {
            Some(steps) => held.landscape().map(|landscape| (landscape, steps)),
            None => held.session().finish(&progress).map(|landscape| (Arc::new(landscape), usize::MAX)),
        };
        if progress.cancelled() || matches!(made, Err(Error::Interrupted(_))) {
            // Whatever was asked meanwhile, saving too, they are still to run.
            self.is_finished = false;
            return Ok(());
        }
        let (landscape, steps) = made?;
        self.publish(opening, landscape, steps);
        self.show_mask()
    }

    fn save(&mut self, file: &Path) -> Result<(), Error> {
        self.write(file)?;
        let state = self.state();
        self.shared.change(|status| status.saved = Some((file.to_owned(), state)));
        Ok(())
    }

    /// Writes what is not saved.
    fn autosave(&mut self, file: &Path) -> Result<(), Error> {
        self.write(file)?;
        let state = self.state();
        self.shared.change(|status| status.autosaved = Some((file.to_owned(), state)));
        Ok(())
    }

    /// What a file that is written now holds.
    fn state(&self) -> State {
        let revision = self.opening.as_ref().map_or(0, |opening| opening.revision);
        State { revision, changes: self.shared.status().changes }
    }

    fn write(&mut self, file: &Path) -> Result<(), Error> {
        let folder = file.parent().unwrap_or(Path::new("/"));
        files::create_dir_all(folder).map_err(|cause| Error::write(folder, &cause))?;
        match (&mut self.held, &self.opening) {
            (Some(held), _) => held.save(file)?,
            (None, Some(opening)) => weald::io::write_whole(file, opening.text.as_bytes())?,
            (None, None) => return Err(nothing_ran()),
        }
        Ok(())
    }

    /// Runs the recipe with all that was done, as `weald run` does.
    fn export(&mut self, number: u64, folder: &Path, outputs: Option<&str>) -> Result<(), Error> {
        let Some(opening) = &self.opening else { return Err(nothing_ran()) };
        files::create_dir_all(folder)
            .map_err(|cause| Error::Run(format!("{} cannot be made: {cause}", folder.display())))?;
        let recipe = if let Some(held) = &mut self.held {
            let file = folder.join("landscape.toml");
            held.save(&file)?;
            if let Some(outputs) = outputs {
                // What is written says how it was made, outputs and all.
                let text = with_outputs(&Recipe::text_of(&file)?, outputs)?;
                weald::io::write_whole(&file, text.as_bytes())?;
            }
            Recipe::load(&file, &Overrides::default())?
        } else {
            let text = outputs.map(|outputs| with_outputs(&opening.text, outputs)).transpose()?;
            Recipe::parse(&opening.file, text.as_ref().unwrap_or(&opening.text), &Overrides::default())?
        };
        let progress = Told { shared: &self.shared, number, watched: &self.shared.superseded };
        let options = Options { engine: opening.engine.clone(), ..Options::into_folder(folder) };
        Run { recipe: &recipe, options }.execute(&progress)?;
        let names = recipe.names();
        self.shared.change(|status| status.exported = Some((folder.to_owned(), names)));
        Ok(())
    }

    /// Brings what the window sees of the history up to date, with the number of a task that is done.
    fn show(&mut self, done: Option<u64>) {
        let until = self.until;
        // The way here grows with every slice; it need not be told more often than the surface.
        let is_due = until.is_none() || self.moments_told.elapsed() >= MOMENTS_EVERY;
        let moments = is_due.then(|| self.held.as_mut().map_or_else(Vec::new, HeldSession::moments));
        if is_due {
            self.moments_told = Instant::now();
        }
        let held = self.held.as_mut().map(|held| {
            let names = held.session().history().names().clone();
            (held.place(), held.steps(), held.written_steps(), names, held.session().history().used())
        });
        self.shared.change(|status| {
            status.done = done.unwrap_or(status.done);
            status.plays = until.is_some();
            status.phase = if until.is_some() { Phase::Simulating } else { Phase::Idle };
            if let Some(moments) = moments {
                status.moments = moments;
            }
            status.held = held.as_ref().map(|held| held.0);
            if let Some((_, steps, written, names, kept)) = held {
                (status.steps, status.written_steps, status.kept) = (steps, written, kept);
                status.names = names.into_iter().collect();
            }
        });
    }
}

fn nothing_ran() -> Error {
    Error::Run("nothing has run yet, for the recipe cannot run as it is".to_owned())
}
