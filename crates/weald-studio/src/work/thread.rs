//! The one who works, on a thread of its own.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use weald::Error;

use super::shared::Shared;
use super::status::Status;
use super::task::Task;
use super::worker::{Rest, Worker};

/// How long it waits at once where there is nothing to do at all.
const LONGEST_REST: Duration = Duration::from_hours(1);

/// The thread, as the window sees it. Dropping it ends the thread.
#[derive(Debug)]
pub struct Thread {
    tasks: Sender<(u64, Task)>,
    shared: Arc<Shared>,
    handle: Option<JoinHandle<()>>,
}

impl Thread {
    /// Begins a thread; `tell` is called from it whenever its status has changed.
    ///
    /// # Errors
    /// [`Error::Run`] where the system has no thread left.
    pub fn new(tell: impl Fn() + Send + Sync + 'static) -> Result<Self, Error> {
        let (tasks, receiver) = channel();
        let shared = Arc::new(Shared::new(tell));
        let worker = Worker::new(Arc::clone(&shared));
        let thread =
            std::thread::Builder::new().name("weald-work".to_owned()).spawn(move || run(worker, &receiver));
        let thread = thread.map_err(|cause| Error::Run(format!("no thread for the simulation: {cause}")))?;
        Ok(Self { tasks, shared, handle: Some(thread) })
    }

    /// Asks for something to be done; answers at once.
    pub(super) fn ask(&self, task: Task) {
        let number = self.shared.ask(task.supersedes());
        // Where the thread has ended after a panic, its status says so.
        if self.tasks.send((number, task)).is_err() {
            self.shared
                .status()
                .error
                .get_or_insert_with(|| "the simulation has ended by a fault of Weald".to_owned());
        }
    }

    /// How many tasks were asked.
    pub(super) fn asked(&self) -> u64 {
        self.shared.asked.load(Ordering::Acquire)
    }

    /// What it shows now.
    pub(super) fn status(&self) -> Status {
        let mut status = self.shared.status().clone();
        if self.handle.as_ref().is_some_and(JoinHandle::is_finished) {
            status.error.get_or_insert_with(|| "the simulation has ended by a fault of Weald".to_owned());
        }
        status
    }
}

impl Drop for Thread {
    fn drop(&mut self) {
        self.ask(Task::End);
        if let Some(thread) = self.handle.take() {
            // A panic of the thread has been told by its status.
            let _ = thread.join();
        }
    }
}

/// Does what comes, until the end is asked or the window is gone.
fn run(mut worker: Worker, tasks: &Receiver<(u64, Task)>) {
    loop {
        // Tasks are taken in their order, but for the end.
        for (number, task) in tasks.try_iter() {
            if matches!(task, Task::End) {
                return;
            }
            worker.ask(number, task);
        }
        let rest = match worker.rest() {
            Rest::None => Duration::ZERO,
            Rest::For(rest) => rest,
            Rest::UntilAsked => LONGEST_REST,
        };
        if !rest.is_zero() {
            match tasks.recv_timeout(rest) {
                Ok((_, Task::End)) | Err(RecvTimeoutError::Disconnected) => return,
                Ok((number, task)) => worker.ask(number, task),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
        worker.work();
    }
}
