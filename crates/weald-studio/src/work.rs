//! The work behind the window: recipes are run, the simulation that a person changes is held, files are saved. The window
//! sends tasks and looks at what is shown; neither ever waits for the other.

mod held;
mod message;
mod mirror;
mod remote;
mod served;
mod shared;
mod status;
mod task;
#[cfg(not(target_arch = "wasm32"))]
mod thread;
mod worker;

use std::rc::Rc;

pub use message::{Array, ChangedFile, Parcel};
pub use remote::{Keep, Remote};
pub use served::{Served, Simulates};
pub use status::{Moment, Phase, Seeds, Shown, Status, Surface};
pub use task::{Opening, Task};
#[cfg(not(target_arch = "wasm32"))]
pub use thread::Thread;

/// Who works.
#[derive(Debug)]
pub enum Work {
    /// A thread of this program.
    #[cfg(not(target_arch = "wasm32"))]
    Thread(Thread),
    /// The worker of a page.
    Remote(Rc<Remote>),
}

impl Work {
    /// Asks for something to be done; answers at once.
    pub fn ask(&self, task: Task) {
        match self {
            #[cfg(not(target_arch = "wasm32"))]
            Self::Thread(thread) => thread.ask(task),
            Self::Remote(remote) => remote.ask(task),
        }
    }

    /// How many tasks were asked: all are done once [`Status::done`] is as large.
    pub fn asked(&self) -> u64 {
        match self {
            #[cfg(not(target_arch = "wasm32"))]
            Self::Thread(thread) => thread.asked(),
            Self::Remote(remote) => remote.asked(),
        }
    }

    /// What it shows now.
    pub fn status(&self) -> Status {
        match self {
            #[cfg(not(target_arch = "wasm32"))]
            Self::Thread(thread) => thread.status(),
            Self::Remote(remote) => remote.status(),
        }
    }
}
