//! What a reader finds wrong with the bytes of a file, before it knows the file's name.

use std::path::Path;

use weald_core::error::Error;

/// What is wrong with the bytes of a file; [`Fault::of`] adds the name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The bytes are damaged or of a kind that is not read.
    #[error("{0}")]
    Damaged(String),
    /// A stated limit would be passed; nothing was allocated.
    #[error("{0}")]
    Limit(String),
}

impl Fault {
    /// Damaged bytes.
    pub fn damaged(what: impl Into<String>) -> Self {
        Self::Damaged(what.into())
    }

    /// The error of the file at `path`.
    #[must_use]
    pub fn of(self, path: &Path) -> Error {
        match self {
            Self::Damaged(what) => Error::input(path, what),
            Self::Limit(what) => Error::Limit(format!("{}: {what}", path.display())),
        }
    }
}
