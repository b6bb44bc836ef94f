//! The worker of a page: takes its messages, works in short turns between them, and sends what has come of it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

use weald::Error;
use weald::engine::Engine;
use web_time::Instant;

use super::message::{Known, Parcel, parcel_of_status, task_of_parcel};
use super::mirror;
use super::shared::Shared;
use super::task::Task;
use super::worker::{Rest, Worker};

/// Least time between two messages on the progress of one task.
const TOLD_EVERY: Duration = Duration::from_millis(50);

/// Where a worker simulates.
#[derive(Clone, Debug, Default)]
pub struct Simulates {
    /// On the processor, unless there is a device.
    pub engine: Engine,
    /// Why no device does, where one could be expected to: goes on from "the processor: ".
    pub without_device: Option<String>,
}

/// The worker.
pub struct Served {
    worker: Worker,
    shared: Arc<Shared>,
    engine: Engine,
    known: Arc<Mutex<Known>>,
    post: Arc<dyn Fn(Parcel) + Send + Sync>,
}

impl Served {
    /// A worker that sends messages by `post`.
    pub fn new(simulates: Simulates, post: impl Fn(Parcel) + Send + Sync + 'static) -> Self {
        let Simulates { engine, without_device } = simulates;
        let post: Arc<dyn Fn(Parcel) + Send + Sync> = Arc::new(post);
        let (sender, told) = (Arc::clone(&post), Mutex::new(Instant::now()));
        let known = Arc::<Mutex<Known>>::default();
        let sent = Arc::clone(&known);
        let shared = Arc::new_cyclic(|weak: &Weak<Shared>| {
            let weak = weak.clone();
            Shared::new(move || {
                // The page sees how far a long task is, and a coarse landscape before the fine one.
                let mut told = locked(&told);
                if told.elapsed() >= TOLD_EVERY
                    && let Some(shared) = weak.upgrade()
                {
                    *told = Instant::now();
                    let status = shared.status().clone();
                    sender(parcel_of_status(Vec::new(), status, &mut locked(&sent)));
                }
            })
        });
        let worker = Worker::new(Arc::clone(&shared)).without_device(without_device);
        Self { worker, shared, engine, known, post }
    }

    /// Takes a message.
    ///
    /// # Errors
    /// [`Error::Run`] for one of another version, those of a change that cannot be read.
    pub fn take(&mut self, parcel: Parcel) -> Result<(), Error> {
        let (files, task) = task_of_parcel(parcel, &self.engine)?;
        mirror::take_over(files);
        if let Some(task) = task.filter(|task| !matches!(task, Task::End)) {
            let number = self.shared.ask(task.supersedes());
            self.worker.ask(number, task);
        }
        Ok(())
    }

    /// Works for a turn, and sends what has come of it. Gives how long there is nothing more to do, as long as nothing
    /// comes; `None` for ever.
    pub fn turn(&mut self) -> Option<Duration> {
        self.worker.work();
        let status = self.shared.status().clone();
        let parcel = parcel_of_status(mirror::changes(), status, &mut locked(&self.known));
        (self.post)(parcel);
        self.rest()
    }

    /// How long there is nothing to do, as long as nothing comes; `None` for ever.
    pub fn rest(&self) -> Option<Duration> {
        match self.worker.rest() {
            Rest::None => Some(Duration::ZERO),
            Rest::For(rest) => Some(rest),
            Rest::UntilAsked => None,
        }
    }
}

/// Numbers that are replaced at once: a panic elsewhere leaves them of use.
fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}
