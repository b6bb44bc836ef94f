//! What a studio is told by who opens it.

use std::path::PathBuf;
use std::rc::Rc;

use weald_gpu::Gpu;

use crate::dialogs::Chooser;
use crate::host::Host;
use crate::work::Remote;

/// How a studio begins.
#[derive(Clone, Default)]
pub struct Options {
    /// A recipe, an elevation model or the folder of a project; where there is none, what was not saved when a studio was
    /// killed, or else a template.
    pub what: Option<PathBuf>,
    /// Where names of what was open of late are kept, and what is not saved, in place of where the system keeps such.
    pub own_files: Option<PathBuf>,
    /// The worker of a page; where there is none, a thread works.
    pub remote: Option<Rc<Remote>>,
    /// The page around it.
    pub host: Option<Rc<dyn Host>>,
    /// What lets the user choose a file or a folder, in place of the dialogs of the system.
    pub chooser: Option<Chooser>,
    /// The device of its window, which other windows have too: what was compiled for one of them is there for all. Where
    /// there is none, it has its device to itself.
    pub gpu: Option<Gpu>,
    /// Whether it begins with a simulation that runs, and no question and no control before [`Studio::show_controls`](crate::Studio::show_controls).
    pub plays: bool,
    /// Whether a picture at rest becomes as fine as its place, however long that takes: who compares pictures wants it.
    pub finest: bool,
}
