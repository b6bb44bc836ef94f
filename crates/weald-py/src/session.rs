//! A step of a recipe under a person's hands.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use weald::edit::{Area, Change};
use weald::recipe::{Overrides, SessionOptions};
use weald::{Error, Size};

use crate::arrays;
use crate::engines::Call;
use crate::errors::exception;
use crate::export;
use crate::landscape::Landscape;
use crate::stored::{self, Origin};
use crate::watch::{Caller, Line, watched};

/// How long a stretch of steps runs between two looks at what the caller wants.
const STRETCH: Duration = Duration::from_millis(50);

/// A session, shared with the thread that works on it.
#[pyclass(frozen, subclass, module = "weald._weald")]
pub(crate) struct Session {
    shared: Arc<Mutex<HeldSession>>,
    origin: Option<Origin>,
    threads: Option<usize>,
}

struct HeldSession {
    session: weald::recipe::Session,
    /// The moments before each thing that was done, so that steps of one call are taken back as one.
    before: Vec<usize>,
    undone: Vec<usize>,
}

impl HeldSession {
    /// Does something that can be taken back as one.
    fn act(
        &mut self,
        act: impl FnOnce(&mut weald::recipe::Session) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let before = self.session.history().here();
        let result = act(&mut self.session);
        if self.session.history().here() != before {
            self.before.push(before);
            self.undone.clear();
        }
        result
    }

    fn undo(&mut self) -> Result<bool, Error> {
        let Some(before) = self.before.pop() else { return Ok(false) };
        let here = self.session.history().here();
        self.session.history().go_to(before)?;
        self.undone.push(here);
        Ok(true)
    }

    fn redo(&mut self) -> Result<bool, Error> {
        let Some(after) = self.undone.pop() else { return Ok(false) };
        let here = self.session.history().here();
        self.session.history().go_to(after)?;
        self.before.push(here);
        Ok(true)
    }

    fn materials(&mut self) -> Vec<String> {
        let start = self.session.history().simulation().start();
        start.materials.iter().map(|material| material.name.clone()).collect()
    }
}

#[pymethods]
impl Session {
    /// Runs the steps before the one that is held.
    #[new]
    fn new(
        py: Python<'_>,
        file: &str,
        text: &str,
        step: Option<usize>,
        memory: u64,
        call: Call,
    ) -> PyResult<Self> {
        let Call { engine, caller } = call;
        let threads = caller.threads;
        let recipe = weald::recipe::Recipe::parse(file, text, &Overrides::default());
        let recipe = recipe.map_err(|error| exception(py, error))?;
        let origin = (!recipe.fractals.is_empty()).then(|| (file.to_owned(), text.to_owned()));
        let work = move |line: &Line| {
            let engine = engine.open(line)?;
            let options = SessionOptions { engine, step, memory, cache: None };
            weald::recipe::Session::open(recipe, options, line)
        };
        let session = watched(py, &caller, work)?;
        let held = HeldSession { session, before: Vec::new(), undone: Vec::new() };
        Ok(Self { shared: Arc::new(Mutex::new(held)), origin, threads })
    }

    /// Steps done.
    #[getter]
    fn steps(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |held| Ok(held.session.steps()))
    }

    /// Steps that the recipe asks for.
    #[getter]
    fn written_steps(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |held| Ok(held.session.written_steps()))
    }

    /// Simulates so many steps; Ctrl-C leaves the session after those that are done.
    #[pyo3(signature = (steps, callback=None))]
    fn advance_by(&self, py: Python<'_>, steps: u64, callback: Option<Py<PyAny>>) -> PyResult<()> {
        self.work(py, callback, move |held, line| held.act(|session| stretches(session, steps, line)))
    }

    /// Paints a stroke, or sets a key.
    fn change(&self, keys: &Bound<'_, PyDict>) -> PyResult<()> {
        let py = keys.py();
        let materials = self.with(py, |held| Ok(held.materials()))?;
        let change = export::change(keys, &materials)?;
        self.work(py, None, move |held, _| {
            held.act(|session| match change {
                Change::Stroke(brush) => session.paint(brush),
                Change::Set(setting) => session.set(setting),
            })
        })
    }

    /// Takes the last call back; `False` where there is none.
    fn undo(&self, py: Python<'_>) -> PyResult<bool> {
        self.work(py, None, |held, _| held.undo())
    }

    /// Does the call again that was taken back last; `False` where there is none.
    fn redo(&self, py: Python<'_>) -> PyResult<bool> {
        self.work(py, None, |held, _| held.redo())
    }

    /// The landscape as it is now, and what the step would report, as JSON.
    fn now(&self, py: Python<'_>) -> PyResult<(Landscape, String)> {
        let (landscape, outcome) = self.work(py, None, |held, _| held.session.landscape())?;
        Ok((Landscape::of(landscape, self.origin.clone()), stored::outcome(&outcome)))
    }

    /// The landscape after the steps that come after this one.
    #[pyo3(signature = (callback=None))]
    fn finish_steps(&self, py: Python<'_>, callback: Option<Py<PyAny>>) -> PyResult<Landscape> {
        let landscape = self.work(py, callback, |held, line| held.session.finish(line))?;
        Ok(Landscape::of(landscape, self.origin.clone()))
    }

    /// The state over a rectangle of cells: an array for each field.
    #[pyo3(signature = (area=None))]
    fn read_patch<'py>(
        &self,
        py: Python<'py>,
        area: Option<(usize, usize, usize, usize)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let canvas = self.work(py, None, move |held, _| {
            let area = match area {
                Some((column, row, columns, rows)) => {
                    Area { first: [column, row], size: Size::new(columns, rows)? }
                }
                None => held.session.history().simulation().whole(),
            };
            held.session.patch(area)
        })?;
        let fields = PyDict::new(py);
        let names: Vec<_> = canvas.fields().map(|(name, _)| name.to_owned()).collect();
        let mut canvas = canvas;
        for (name, field) in names.iter().zip(canvas.fields_mut().map(|(_, field)| field)) {
            let none = weald::Field::filled(Size { columns: 0, rows: 0 }, 0.0);
            fields.set_item(name, arrays::given(py, std::mem::replace(field, none))?)?;
        }
        Ok(fields)
    }

    /// Writes the session as a recipe, and the script of what was done beside it.
    fn save_recipe(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        self.with(py, |held| held.session.save(&file))
    }
}

impl Session {
    /// Does something quick with the session.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut HeldSession) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let shared = &self.shared;
        let result = py.detach(|| lock(shared).and_then(|mut held| work(&mut held)));
        result.map_err(|error| exception(py, error))
    }

    /// Does something that may take long with the session.
    fn work<T: Send + 'static>(
        &self,
        py: Python<'_>,
        callback: Option<Py<PyAny>>,
        work: impl FnOnce(&mut HeldSession, &Line) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let shared = Arc::clone(&self.shared);
        let caller = Caller { callback, threads: self.threads };
        watched(py, &caller, move |line| lock(&shared).and_then(|mut held| work(&mut held, line)))
    }
}

/// A panic within a simulation leaves it in pieces.
fn lock(shared: &Mutex<HeldSession>) -> Result<MutexGuard<'_, HeldSession>, Error> {
    let broken = |_: PoisonError<_>| Error::Run("the session broke down; open it again".to_owned());
    shared.lock().map_err(broken)
}

/// Steps in stretches that last a moment each, so that nobody waits long for an end.
fn stretches(session: &mut weald::recipe::Session, steps: u64, line: &Line) -> Result<(), Error> {
    let (mut done, mut stretch) = (0, 1);
    let cells = session.history().simulation().start().domain.size.cells();
    while done < steps {
        if line.is_cancelled() {
            return Err(Error::Interrupted(format!("interrupted after {done} of {steps} steps")));
        }
        let now = stretch.min(steps - done);
        let started = Instant::now();
        session.advance(now)?;
        done += now;
        line.at(done, steps, cells);
        stretch = if started.elapsed() < STRETCH { now.saturating_mul(2) } else { (now / 2).max(1) };
    }
    Ok(())
}
