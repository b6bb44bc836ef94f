//! `weald studio`.

use std::path::PathBuf;

use crate::failure::Failure;

pub(crate) fn studio(what: Option<PathBuf>) -> Result<(), Failure> {
    Ok(weald_studio::open(what)?)
}
