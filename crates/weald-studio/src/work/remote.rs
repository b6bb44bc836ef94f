//! The work as a page sees it that has a worker.

use std::cell::{Cell, RefCell};
use std::path::Path;

use super::message::{Parcel, parcel_of_task, take_status};
use super::mirror;
use super::status::Status;
use super::task::Task;

/// What becomes of a file that has changed: its bytes, or `None` for one that is gone.
pub type Keep = Box<dyn Fn(&Path, Option<&[u8]>)>;

/// A worker that is somewhere else.
pub struct Remote {
    status: RefCell<Status>,
    /// How many tasks were asked.
    asked: Cell<u64>,
    post: Box<dyn Fn(Parcel)>,
    keep: Keep,
}

impl std::fmt::Debug for Remote {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Remote").finish_non_exhaustive()
    }
}

impl Remote {
    /// A worker that gets messages by `post`. `keep` is given every file that changes on either side.
    pub fn new(post: impl Fn(Parcel) + 'static, keep: Keep) -> Self {
        Self { status: RefCell::default(), asked: Cell::default(), post: Box::new(post), keep }
    }

    /// Takes a message of the worker.
    pub fn take(&self, parcel: Parcel) {
        let taken = take_status(parcel, &mut self.status.borrow_mut());
        match taken {
            Ok(files) => {
                for (path, bytes) in &files {
                    (self.keep)(path, bytes.as_deref());
                }
                mirror::take_over(files);
            }
            Err(error) => self.fail(error.to_string()),
        }
    }

    /// Notes that the worker has failed.
    pub fn fail(&self, message: String) {
        self.status.borrow_mut().error = Some(message);
    }

    pub(super) fn ask(&self, task: Task) {
        self.asked.update(|asked| asked + 1);
        self.send(Some(task));
    }

    pub(super) fn asked(&self) -> u64 {
        self.asked.get()
    }

    pub(super) fn status(&self) -> Status {
        self.send(None);
        self.status.borrow().clone()
    }

    /// Sends what has changed here with a task, or by itself.
    fn send(&self, task: Option<Task>) {
        let files = mirror::changes();
        for (path, bytes) in &files {
            (self.keep)(path, bytes.as_deref());
        }
        if task.is_some() || !files.is_empty() {
            (self.post)(parcel_of_task(files, task));
        }
    }
}
