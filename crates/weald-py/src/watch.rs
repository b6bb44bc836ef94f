//! Work in a thread of its own, while Python hears of its progress and can end it.
//!
//! Signals of Python reach its main thread alone, and only while that runs Python. So the caller waits in short stretches,
//! without the lock of the interpreter, passes on what the work tells, and looks for signals between them.

use std::path::Path;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use weald::engine::Watcher;
use weald::recipe::{Progress, StepReport};
use weald::{Error, Landscape};

use crate::errors::{exception, raise};

/// Longest time between two looks for signals.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// How long a work that is to end may take to do so before the caller goes on without it.
const GRACE: Duration = Duration::from_millis(120);

/// Least time between two reports of the progress of a step.
const REPORT_EVERY: Duration = Duration::from_millis(40);

/// What the work tells.
enum Told<T> {
    Step { number: usize, count: usize, name: String },
    Iterations { done: u64, total: u64, cells: usize },
    Output { number: usize, count: usize, file: String },
    Note(String),
    Done(Result<T, Error>),
}

/// What the caller wants to hear, and how many threads work.
pub(crate) struct Caller {
    pub(crate) callback: Option<Py<PyAny>>,
    pub(crate) threads: Option<usize>,
}

/// The line from the work to its caller.
pub(crate) struct Line {
    tell: Box<dyn Fn(Told<()>) + Send + Sync>,
    cancelled: Arc<AtomicBool>,
    reported: Mutex<Option<Instant>>,
    made: Mutex<Option<(Landscape, Vec<StepReport>)>>,
}

impl Line {
    /// Whether the caller wants an end.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// How far the work is.
    pub(crate) fn at(&self, done: u64, total: u64, cells: usize) {
        let mut reported = self.reported.lock().unwrap_or_else(PoisonError::into_inner);
        let is_due = reported.is_none_or(|last| last.elapsed() >= REPORT_EVERY);
        if is_due || done == total {
            *reported = Some(Instant::now());
            (self.tell)(Told::Iterations { done, total, cells });
        }
    }

    /// What all steps of a run made, and what they reported.
    pub(crate) fn made(&self) -> Option<(Landscape, Vec<StepReport>)> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Something that the user should know.
    pub(crate) fn say(&self, text: &str) {
        (self.tell)(Told::Note(text.to_owned()));
    }
}

impl Watcher for Line {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.at(done, total, cells);
    }

    fn cancelled(&self) -> bool {
        self.is_cancelled()
    }
}

impl Progress for Line {
    fn step(&self, number: usize, count: usize, name: &str) {
        (self.tell)(Told::Step { number, count, name: name.to_owned() });
    }

    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.at(done, total, cells);
    }

    fn output(&self, number: usize, count: usize, file: &Path) {
        (self.tell)(Told::Output { number, count, file: file.display().to_string() });
    }

    fn note(&self, text: &str) {
        self.say(text);
    }

    fn made(&self, landscape: &Landscape, steps: &[StepReport]) {
        let made = (landscape.clone(), steps.to_vec());
        *self.made.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
    }

    fn cancelled(&self) -> bool {
        self.is_cancelled()
    }
}

/// Does some work on threads of its own, on as many as the caller says.
///
/// Ctrl-C and a callback that raises or says `False` end it: it is asked to stop, and who does not within a moment is left
/// to end by itself, without effect. So the work owns all that it works on.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    caller: &Caller,
    work: impl FnOnce(&Line) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let (sender, mut told) = channel();
    let cancelled = Arc::new(AtomicBool::new(false));
    start(sender, Arc::clone(&cancelled), caller.threads, work)?;
    let mut ended = None;
    loop {
        let next = next_news(py, &mut told, LOOK_EVERY);
        let wish = match next {
            Ok(Told::Done(result)) => return result.map_err(|error| exception(py, error)),
            Ok(news) if ended.is_none() => report(py, caller, news),
            Ok(_) | Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => return Err(broken()),
        };
        if let Err(error) = wish.and_then(|()| py.check_signals()) {
            cancelled.store(true, Ordering::Relaxed);
            ended.get_or_insert(error);
        }
        if let Some(error) = ended.take() {
            let last = last_words(py, &mut told);
            return Err(ending(py, error, last));
        }
    }
}

fn start<T: Send + 'static>(
    sender: Sender<Told<T>>,
    cancelled: Arc<AtomicBool>,
    threads: Option<usize>,
    work: impl FnOnce(&Line) -> Result<T, Error> + Send + 'static,
) -> PyResult<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    let pool = pool.map_err(|cause| PyRuntimeError::new_err(format!("cannot start threads: {cause}")))?;
    let to_caller = sender.clone();
    let tell = Box::new(move |news| {
        // Who has gone on without the work does not listen.
        let _ = to_caller.send(without_result(news));
    });
    let line = Line { tell, cancelled, reported: Mutex::new(None), made: Mutex::new(None) };
    let begun = std::thread::Builder::new().name("weald".to_owned()).spawn(move || {
        let result = pool.install(|| work(&line));
        let _ = sender.send(Told::Done(result));
    });
    begun.map(drop).map_err(|cause| PyRuntimeError::new_err(format!("cannot start a thread: {cause}")))
}

fn without_result<T>(news: Told<()>) -> Told<T> {
    match news {
        Told::Step { number, count, name } => Told::Step { number, count, name },
        Told::Iterations { done, total, cells } => Told::Iterations { done, total, cells },
        Told::Output { number, count, file } => Told::Output { number, count, file },
        Told::Note(text) => Told::Note(text),
        Told::Done(_) => unreachable!("the work alone is done"),
    }
}

fn next_news<T: Send>(
    py: Python<'_>,
    told: &mut Receiver<Told<T>>,
    time: Duration,
) -> Result<Told<T>, RecvTimeoutError> {
    py.detach(move || {
        let told = told; // the whole of it moves, since a shared one cannot
        told.recv_timeout(time)
    })
}

/// Tells the callback; an error is what it raised, or that it said `False`.
fn report<T>(py: Python<'_>, caller: &Caller, news: Told<T>) -> PyResult<()> {
    let Some(callback) = &caller.callback else { return Ok(()) };
    let fields = PyDict::new(py);
    let kind = match news {
        Told::Step { number, count, name } => {
            fields.set_item("number", number)?;
            fields.set_item("count", count)?;
            fields.set_item("name", name)?;
            "step"
        }
        Told::Iterations { done, total, cells } => {
            fields.set_item("done", done)?;
            fields.set_item("total", total)?;
            fields.set_item("cells", cells)?;
            "progress"
        }
        Told::Output { number, count, file } => {
            fields.set_item("number", number)?;
            fields.set_item("count", count)?;
            fields.set_item("name", file)?;
            "output"
        }
        Told::Note(text) => {
            fields.set_item("text", text)?;
            "note"
        }
        Told::Done(_) => return Ok(()),
    };
    let progress = py.import("weald._progress")?.getattr("Progress")?.call((kind,), Some(&fields))?;
    let answer = callback.bind(py).call1((progress,))?;
    if answer.extract::<bool>().is_ok_and(|goes_on| !goes_on) {
        return Err(raise(py, "Cancelled", "the callback said that the run is to end", PyDict::new(py))?);
    }
    Ok(())
}

/// What the work says at its end, where it ends in time.
fn last_words<T: Send>(py: Python<'_>, told: &mut Receiver<Told<T>>) -> Option<String> {
    let until = Instant::now() + GRACE;
    loop {
        let left = until.checked_duration_since(Instant::now())?;
        match next_news(py, told, left) {
            Ok(Told::Done(Err(error))) => return Some(error.to_string()),
            Ok(Told::Done(Ok(_))) => return Some("interrupted at the end".to_owned()),
            Ok(_) => {}
            Err(_) => return None,
        }
    }
}

/// The exception of an end that was asked for: Ctrl-C says where the work was.
fn ending(py: Python<'_>, error: PyErr, last: Option<String>) -> PyErr {
    if !error.is_instance_of::<PyKeyboardInterrupt>(py) {
        return error;
    }
    let message = last.unwrap_or_else(|| {
        "interrupted; what was running ends by itself in a moment, and changes nothing that Python holds"
            .to_owned()
    });
    raise(py, "Interrupted", &message, PyDict::new(py)).unwrap_or_else(|fault| fault)
}

/// The work has ended without a result.
fn broken() -> PyErr {
    PyRuntimeError::new_err("the work ended in a panic, which is a bug of Weald; its message is on stderr")
}
