//! The thread itself: takes tasks in their order, and simulates in short slices between them.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use weald::edit::Action;
use weald::erode::interactive_names;
use weald::recipe::{Cache, Options, Overrides, Progress, Recipe, Run, Session, SessionOptions};
use weald::{Error, Landscape};

use super::held::HeldSession;
use super::status::{Phase, Shown, Status, Surface};
use super::task::{Opening, Task};
use crate::state::State;

/// How long the simulation runs between two looks at what is asked.
const SLICE: Duration = Duration::from_millis(20);

/// Least time between two surfaces while it runs: what a window can draw.
const SURFACE_EVERY: Duration = Duration::from_millis(60);

/// Least time between two lists of what was done, while it runs.
const MOMENTS_EVERY: Duration = Duration::from_millis(250);

/// How long nothing is asked before the steps after the one that is held run.
const REST: Duration = Duration::from_millis(400);

/// How long it waits at once where there is nothing to do at all.
const LONGEST_REST: Duration = Duration::from_hours(1);

/// Bytes of results that are kept in memory, so that a change runs again from the changed step only.
const CACHE_BYTES: u64 = 1 << 30;

/// The thread, as the window sees it. Dropping it ends the thread.
#[derive(Debug)]
pub struct Work {
    tasks: Sender<(u64, Task)>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    status: Mutex<Status>,
    /// Number of the last task that makes what is computed now needless.
    superseded: AtomicU64,
    /// Number of the last task.
    asked: AtomicU64,
    /// Tells the window that there is something new.
    tell: Box<dyn Fn() + Send + Sync>,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Shared").finish_non_exhaustive()
    }
}

impl Shared {
    /// A status is only ever replaced part by part, so a panic elsewhere leaves it of use.
    fn status(&self) -> MutexGuard<'_, Status> {
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut Status)) {
        change(&mut self.status());
        (self.tell)();
    }
}

impl Work {
    /// Begins a thread; `tell` is called from it whenever its status has changed.
    ///
    /// # Errors
    /// [`Error::Run`] where the system has no thread left.
    pub fn new(tell: impl Fn() + Send + Sync + 'static) -> Result<Self, Error> {
        let (tasks, receiver) = channel();
        let shared = Arc::new(Shared {
            status: Mutex::default(),
            superseded: AtomicU64::new(0),
            asked: AtomicU64::new(0),
            tell: Box::new(tell),
        });
        let worker = Worker {
            tasks: receiver,
            waiting: VecDeque::new(),
            shared: Arc::clone(&shared),
            cache: Arc::new(Cache::in_memory(CACHE_BYTES)),
            opening: None,
            held: None,
            until: None,
            slice: 1,
            surfaced: Instant::now(),
            moments_told: Instant::now(),
            is_finished: true,
        };
        let thread = std::thread::Builder::new().name("weald-work".to_owned()).spawn(move || worker.run());
        let thread = thread.map_err(|cause| Error::Run(format!("no thread for the simulation: {cause}")))?;
        Ok(Self { tasks, shared, thread: Some(thread) })
    }

    /// Asks for something to be done; answers at once.
    pub fn ask(&self, task: Task) {
        let number = self.shared.asked.fetch_add(1, Ordering::AcqRel) + 1;
        if task.supersedes() {
            self.shared.superseded.store(number, Ordering::Release);
        }
        // Where the thread has ended after a panic, its status says so.
        if self.tasks.send((number, task)).is_err() {
            self.shared
                .status()
                .error
                .get_or_insert_with(|| "the simulation has ended by a fault of Weald".to_owned());
        }
    }

    /// What it shows now.
    pub fn status(&self) -> Status {
        let mut status = self.shared.status().clone();
        if self.thread.as_ref().is_some_and(JoinHandle::is_finished) {
            status.error.get_or_insert_with(|| "the simulation has ended by a fault of Weald".to_owned());
        }
        status
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        self.ask(Task::End);
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has been told by its status.
            let _ = thread.join();
        }
    }
}

/// What the thread does next.
enum Next {
    Task(u64, Task),
    Work,
    End,
}

struct Worker {
    tasks: Receiver<(u64, Task)>,
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
    moments_told: Instant,
    /// Whether the steps after the one that is held have run since it changed.
    is_finished: bool,
}

impl Worker {
    fn run(mut self) {
        loop {
            let done = match self.next() {
                Next::Task(number, task) => self.take(number, task),
                Next::Work if self.until.is_some() => self.simulate(),
                Next::Work => self.finish(),
                Next::End => return,
            };
            match done {
                Ok(()) | Err(Error::Interrupted(_)) => {}
                Err(error) => {
                    self.until = None;
                    self.shared.change(|status| status.error = Some(error.to_string()));
                }
            }
            self.show();
        }
    }

    fn next(&mut self) -> Next {
        // Tasks are taken in their order, but for the end.
        while let Ok((number, task)) = self.tasks.try_recv() {
            if matches!(task, Task::End) {
                return Next::End;
            }
            self.waiting.push_back((number, task));
        }
        if let Some((number, task)) = self.waiting.pop_front() {
            return Next::Task(number, task);
        }
        if self.until.is_some() {
            return Next::Work;
        }
        let rest = if self.is_finished { LONGEST_REST } else { REST };
        match self.tasks.recv_timeout(rest) {
            Ok((_, Task::End)) | Err(RecvTimeoutError::Disconnected) => Next::End,
            Ok((number, task)) => Next::Task(number, task),
            Err(RecvTimeoutError::Timeout) => Next::Work,
        }
    }

    fn take(&mut self, number: u64, task: Task) -> Result<(), Error> {
        self.shared.change(|status| status.error = None);
        match task {
            Task::Open(opening) => return self.open(number, *opening),
            Task::Save(file) => return self.save(&file),
            Task::Export(folder) => return self.export(number, &folder),
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
            Task::Advance(steps) => held.advance(steps)?,
            Task::Set(setting) => held.set(setting)?,
            Task::Stroke { brush, stroke, replaces } => held.paint(brush, stroke, replaces)?,
            Task::Undo => drop(held.undo()?),
            Task::Redo => drop(held.redo()?),
            Task::GoTo(moment) => held.go_to(moment)?,
            Task::Name(name) => held.session().history().name(&name),
            Task::Open(_) | Task::Save(_) | Task::Export(_) | Task::End => {}
        }
        self.changed()
    }

    /// Tells of a change at once.
    fn changed(&mut self) -> Result<(), Error> {
        self.is_finished = false;
        self.shared.status().changes += 1;
        self.surface()
    }

    fn open(&mut self, number: u64, mut opening: Opening) -> Result<(), Error> {
        self.shared.change(|status| {
            (status.revision, status.notes) = (opening.revision, Vec::new());
            (status.plays, status.pace) = (false, 0.0);
        });
        self.until = None;
        if let Some(held) = self.held.as_ref().filter(|_| opening.keeps_edits) {
            // What the text says was done by hand is among what is done again.
            opening.text = held.without_edits(&opening);
        }
        let recipe = Recipe::parse(&opening.file, &opening.text, &Overrides::default())?;
        let wanted = opening.steps.unwrap_or(recipe.steps.len());
        let names = interactive_names();
        let can_hold = recipe.steps[..wanted.min(recipe.steps.len())]
            .iter()
            .rposition(|planned| names.contains(&planned.entry.name));
        let again = self.again(&opening);
        let progress = Told { shared: &self.shared, number, watched: &self.shared.superseded };
        let Some(place) = can_hold else {
            let landscape = self.coarse_first(&opening, &recipe, wanted, &progress);
            self.held = None;
            self.is_finished = true;
            let landscape = landscape?;
            self.publish(&opening, Arc::new(landscape), wanted);
            self.opening = Some(opening);
            return Ok(());
        };
        let options = SessionOptions {
            engine: opening.engine.clone(),
            step: Some(place + 1),
            cache: Some(Arc::clone(&self.cache)),
            ..SessionOptions::default()
        };
        let names_files = !recipe.inputs().is_empty();
        let session = Session::open(recipe, options, &progress)?;
        let mut held = HeldSession::new(session, (&opening.file, &opening.text), names_files);
        if let Err(error) = held.follow(again) {
            let note =
                format!("what was done by hand could not all be done again on the new ground: {error}");
            self.shared.change(|status| status.notes.push(note));
        }
        let (landscape, materials) = (held.landscape()?, held.surface()?.0.materials);
        self.shared.change(|status| status.materials = materials);
        self.held = Some(held);
        self.publish(&opening, landscape, place + 1);
        self.opening = Some(opening);
        self.is_finished = false;
        Ok(())
    }

    /// What is to be done again on the new ground: all, where the same step is held.
    fn again(&mut self, opening: &Opening) -> Vec<Action> {
        match &mut self.held {
            Some(held) if opening.keeps_edits => held.actions(),
            _ => Vec::new(),
        }
    }

    /// The landscape of a recipe without a simulation, shown coarse until it is there in full.
    fn coarse_first(
        &self,
        opening: &Opening,
        recipe: &Recipe,
        steps: usize,
        progress: &Told<'_>,
    ) -> Result<Landscape, Error> {
        let preview = Overrides { preview: true, ..Overrides::default() };
        let coarse = Recipe::parse(&opening.file, &opening.text, &preview);
        if let Ok(coarse) = coarse.as_ref().map_err(ToString::to_string)
            && coarse.effective() != recipe.effective()
        {
            // What cannot be shown coarse is shown once it is there.
            if let Ok(landscape) = coarse.landscape_after(steps, &opening.engine, Some(&self.cache), progress)
            {
                self.publish(opening, Arc::new(landscape), steps);
            }
        }
        recipe.landscape_after(steps, &opening.engine, Some(&self.cache), progress)
    }

    fn publish(&self, opening: &Opening, landscape: Arc<Landscape>, steps: usize) {
        let valid = landscape.domain.valid.as_ref();
        let lowest = landscape
            .field("height")
            .ok()
            .and_then(|height| height.range(valid))
            .map_or(0.0, |range| range.0);
        self.shared.change(|status| {
            let (number, changes) =
                (status.shown.as_ref().map_or(1, |shown| shown.number + 1), status.changes);
            status.shown =
                Some(Shown { landscape, lowest, number, revision: opening.revision, steps, changes });
            status.surface = None;
        });
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
        let began = Instant::now();
        held.advance(steps)?;
        self.is_finished = false;
        let took = began.elapsed();
        let pace = steps as f64 / took.as_secs_f64().max(1e-6);
        self.slice = ((pace * SLICE.as_secs_f64()) as u64).clamp(1, 4 * steps);
        let mut status = self.shared.status();
        status.pace = if status.pace > 0.0 { 0.9 * status.pace + 0.1 * pace } else { pace };
        status.changes += 1;
        drop(status);
        if self.surfaced.elapsed() >= SURFACE_EVERY { self.surface() } else { Ok(()) }
    }

    /// Shows ground and water as they are.
    fn surface(&mut self) -> Result<(), Error> {
        let Some(held) = &mut self.held else { return Ok(()) };
        let (canvas, ground) = held.surface()?;
        let (canvas, ground) = (Arc::new(canvas), Arc::new(ground));
        self.surfaced = Instant::now();
        self.shared.change(|status| {
            let shown = status.shown.as_ref().map_or(0, |shown| shown.number);
            let number = status.surface.as_ref().map_or(1, |surface| surface.number + 1);
            status.surface = Some(Surface { ground, canvas, number, shown });
        });
        Ok(())
    }

    /// Runs the steps after the one that is held, unless something else is asked meanwhile.
    fn finish(&mut self) -> Result<(), Error> {
        if std::mem::replace(&mut self.is_finished, true) {
            return Ok(());
        }
        let (Some(held), Some(opening)) = (&mut self.held, &self.opening) else { return Ok(()) };
        let number = self.shared.asked.load(Ordering::Acquire);
        let progress = Told { shared: &self.shared, number, watched: &self.shared.asked };
        let (landscape, steps) = match opening.steps {
            Some(steps) => (held.landscape()?, steps),
            None => (Arc::new(held.session().finish(&progress)?), usize::MAX),
        };
        if progress.cancelled() {
            self.is_finished = false;
            return Ok(());
        }
        self.publish(opening, landscape, steps);
        Ok(())
    }

    fn save(&mut self, file: &Path) -> Result<(), Error> {
        match (&mut self.held, &self.opening) {
            (Some(held), _) => held.save(file)?,
            (None, Some(opening)) => weald::io::write_whole(file, opening.text.as_bytes())?,
            (None, None) => return Ok(()),
        }
        let revision = self.opening.as_ref().map_or(0, |opening| opening.revision);
        self.shared.change(|status| {
            status.saved = Some((file.to_owned(), State { revision, changes: status.changes }));
        });
        Ok(())
    }

    /// Runs the recipe with all that was done, as `weald run` does.
    fn export(&mut self, number: u64, folder: &Path) -> Result<(), Error> {
        let Some(opening) = &self.opening else { return Ok(()) };
        std::fs::create_dir_all(folder)
            .map_err(|cause| Error::Run(format!("{} cannot be made: {cause}", folder.display())))?;
        let recipe = if let Some(held) = &mut self.held {
            let file = folder.join("landscape.toml");
            held.save(&file)?;
            Recipe::load(&file, &Overrides::default())?
        } else {
            Recipe::parse(&opening.file, &opening.text, &Overrides::default())?
        };
        let progress = Told { shared: &self.shared, number, watched: &self.shared.superseded };
        let options = Options { engine: opening.engine.clone(), ..Options::into_folder(folder) };
        Run { recipe: &recipe, options }.execute(&progress)?;
        let names = recipe.names();
        self.shared.change(|status| status.exported = Some((folder.to_owned(), names)));
        Ok(())
    }

    /// Brings what the window sees of the history up to date.
    fn show(&mut self) {
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

/// Tells the window how far a run is, and ends it once something else is asked.
struct Told<'a> {
    shared: &'a Shared,
    number: u64,
    watched: &'a AtomicU64,
}

impl Progress for Told<'_> {
    fn step(&self, step: usize, count: usize, name: &str) {
        let name = name.to_owned();
        self.shared.change(|status| status.phase = Phase::Running { step, count, name, share: None });
    }

    fn progress(&self, done: u64, total: u64, _: usize) {
        self.shared.change(|status| {
            if let Phase::Running { share, .. } = &mut status.phase {
                *share = Some(done as f32 / total.max(1) as f32);
            }
        });
    }

    fn output(&self, _: usize, _: usize, file: &Path) {
        let file = file.display().to_string();
        self.shared.change(|status| status.phase = Phase::Writing(file));
    }

    fn note(&self, text: &str) {
        self.shared.change(|status| status.notes.push(text.to_owned()));
    }

    fn cancelled(&self) -> bool {
        self.watched.load(Ordering::Acquire) > self.number
    }
}
