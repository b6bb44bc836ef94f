//! The thread that works: it runs recipes, holds the simulation that a person changes, and saves. The window sends it tasks
//! and looks at what it shows; neither ever waits for the other.

mod held;
mod status;
mod task;
mod thread;

pub use status::{Moment, Phase, Shown, Status, Surface};
pub use task::{Opening, Task};
pub use thread::Work;
