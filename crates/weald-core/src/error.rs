//! Errors, sorted by who must act. Where a program would act on one, it has fields: [`NotFinite`], [`Limit`] and
//! [`DeviceError`]; all else is a sentence for the user.

mod device;
mod limit;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub use device::{DeviceError, DeviceErrorKind};
pub use limit::{Limit, Quantity, bytes_from_words, bytes_in_words};

/// Everything that can end a run early. [`Error::exit_code`] is the exit code of the command.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The recipe must be mended by its author.
    #[error("{0}")]
    Recipe(#[from] RecipeError),
    /// An input file is damaged or of a kind that Weald does not read.
    #[error("{}: {what}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// What is wrong, where, and what would be right.
        what: String,
    },
    /// A stated limit would be passed; nothing was allocated.
    #[error("{0}")]
    Limit(#[from] Limit),
    /// The run itself failed: an unwritable folder, a full disk, a layer that is missing.
    #[error("{0}")]
    Run(String),
    /// A step gave a value that is infinite or no number.
    #[error("{0}")]
    NotFinite(#[from] NotFinite),
    /// A device failed: none is there, it was lost, its memory is full.
    #[error("{0}")]
    Device(#[from] DeviceError),
    /// The user stopped the run. The message says how to go on.
    #[error("{0}")]
    Interrupted(String),
}

impl Error {
    /// 1 run failed, 3 bad recipe, 4 bad input file, 5 over a stated limit, 130 interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Run(_) | Self::NotFinite(_) | Self::Device(_) => 1,
            Self::Recipe(_) => 3,
            Self::Input { .. } => 4,
            Self::Limit(_) => 5,
            Self::Interrupted(_) => 130,
        }
    }

    /// A damaged or unreadable input file.
    pub fn input(path: &Path, what: impl Into<String>) -> Self {
        Self::Input { path: path.to_owned(), what: what.into() }
    }

    /// A file or folder that could not be written.
    pub fn write(path: &Path, cause: &std::io::Error) -> Self {
        Self::Run(format!("cannot write {}: {cause}{}", path.display(), remedy(cause.kind())))
    }
}

/// What is said of something that a build leaves out, and of the feature that brings it.
pub fn left_out(what: &str, feature: &str) -> String {
    format!("{what} is not part of this build: build with the feature `{feature}`")
}

/// What to do where a file cannot be written, as far as the cause tells.
fn remedy(cause: ErrorKind) -> &'static str {
    match cause {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "; make room, or choose another folder"
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "; choose a folder that you may write to"
        }
        ErrorKind::NotFound => "; make the folder first",
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            "; a file stands where a folder is needed: choose another folder"
        }
        _ => "",
    }
}

/// Where a value is infinite or no number, for a program that goes on with gentler parameters.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct NotFinite {
    /// Name of the step, where a recipe was run.
    pub step: Option<String>,
    /// Iteration after which it was found, within a simulation.
    pub iteration: Option<u64>,
    /// The layer, or the plane of a simulation.
    pub layer: String,
    /// Column and row: of the landscape, or within a simulation of its grid, which around an open border has one more
    /// cell on each side.
    pub cell: [usize; 2],
    /// What the user should know: where, and what to do.
    pub message: String,
}

/// All that is wrong with a recipe, so that one look mends it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", diagnostics.iter().map(|c| c.in_file(file)).collect::<Vec<_>>().join("\n"))]
pub struct RecipeError {
    /// Name of the recipe file, as the user gave it.
    pub file: String,
    /// One complaint a fault, in the order of the file.
    pub diagnostics: Vec<Diagnostic>,
}

/// One fault of a recipe.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Line in the file, counted from 1; 0 for what came from the command line, [`Diagnostic::NO_LINE`] for what is wrong
    /// with the file as a whole.
    pub line: usize,
    /// What is wrong: the key, the value, what is legal, what was probably meant.
    pub message: String,
}

impl Diagnostic {
    /// The line of a fault of the whole file, as that it is not there.
    pub const NO_LINE: usize = usize::MAX;

    fn in_file(&self, file: &str) -> String {
        match self.line {
            0 => format!("{file}, as changed on the command line: {}", self.message),
            Self::NO_LINE => format!("{file}: {}", self.message),
            line => format!("{file}:{line}: {}", self.message),
        }
    }
}
