//! What the window asks of the thread that works.

use std::path::PathBuf;

use weald::edit::{Brush, Setting};
use weald::engine::Engine;

/// A recipe to be shown and held.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Name of the recipe's file, from whose folder its paths start.
    pub file: String,
    /// Its text.
    pub text: String,
    /// Which text of the document it is: results of other ones are dropped.
    pub revision: u64,
    /// Where simulations run.
    pub engine: Engine,
    /// How many of its steps are shown, where not all.
    pub steps: Option<usize>,
    /// Whether what was done so far by hand is done again on the new ground.
    pub keeps_edits: bool,
}

/// Something to be done, in the order of asking.
#[derive(Clone, Debug)]
pub enum Task {
    /// Runs a recipe as far as the step that can be held, and holds that.
    Open(Box<Opening>),
    /// Lets the simulation run, or stands it still.
    Play(bool),
    /// Simulates so many steps.
    Advance(u64),
    /// Lets it run until the recipe's own end of the step.
    PlayToEnd,
    /// Gives a key of the step another value.
    Set(Setting),
    /// Paints a stroke, or more of it.
    Stroke {
        /// What is painted.
        brush: Brush,
        /// Which stroke of the hand it belongs to: all of one are undone as one.
        stroke: u64,
        /// Whether it takes the place of what was last painted of the same stroke, where no step came between.
        replaces: bool,
    },
    /// Takes the last stroke, setting or stretch of steps back.
    Undo,
    /// Does again what was taken back last.
    Redo,
    /// Goes to a moment of any branch.
    GoTo(usize),
    /// Gives this moment a name.
    Name(String),
    /// Gives the moment of a name another name.
    Rename {
        /// The name that it has.
        from: String,
        /// The one that it is to have.
        to: String,
    },
    /// Writes the recipe with all that was done: a text for `weald run`, and its script beside it.
    Save(PathBuf),
    /// Writes the same in case that the program is killed. Nobody asked for it: what went wrong last is still told.
    Keep(PathBuf),
    /// Runs the recipe with all that was done, and writes its outputs, or others in their place, into a folder.
    Export {
        /// The folder.
        folder: PathBuf,
        /// `[[output]]` tables in place of those of the recipe.
        outputs: Option<String>,
    },
    /// Makes the landscapes of several seeds, coarse, with a picture of each in a folder, whenever there is nothing else to do.
    Seeds {
        /// Where the pictures go.
        folder: PathBuf,
        /// The first seed.
        first: u64,
        /// How many, one after the other.
        count: u64,
    },
    /// Ends that.
    EndSeeds,
    /// Forgets the recipe that was opened last: another is shown that cannot run yet.
    Close,
    /// Ends the thread.
    End,
}

impl Task {
    /// Whether what is being computed now is no longer wanted once this is asked.
    pub(super) fn supersedes(&self) -> bool {
        matches!(self, Self::Open(_) | Self::Close | Self::End)
    }
}
