//! What a reader finds wrong with the bytes of a file, before it knows the file's name.

use std::path::Path;

use weald_core::error::{Error, Limit};

/// What is wrong with the bytes of a file; [`Fault::of`] adds the name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The bytes are damaged or of a kind that is not read.
    #[error("{0}")]
    Damaged(String),
    /// A stated limit would be passed; nothing was allocated.
    #[error("{0}")]
    Limit(#[from] Limit),
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
            Self::Limit(limit) => limit.of(path.display()).into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use weald_core::error::Quantity;

    use super::*;

    #[test]
    fn the_limit_of_a_file_keeps_its_numbers_and_names_the_file() {
        let limit = Limit::new(Quantity::Cells, 9, 0..=8).of("a raster of 3 × 3 cells");
        let error = Fault::Limit(limit.clone()).of(Path::new("land.tif"));
        let message = "land.tif: a raster of 3 × 3 cells: 9 cells, at most 8 are allowed";
        assert_eq!(error.to_string(), message);
        let Error::Limit(Limit { what, asked, allowed, .. }) = error else { panic!("{message}") };
        assert_eq!((what, asked, allowed), (limit.what, limit.asked, limit.allowed));
    }
}
