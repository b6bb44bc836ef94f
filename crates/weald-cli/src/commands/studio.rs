//! `weald studio`.

use std::path::PathBuf;

use weald_studio::Options;

use crate::failure::Failure;

pub(crate) fn studio(what: Option<PathBuf>) -> Result<(), Failure> {
    let own_files = std::env::var_os("WEALD_STATE").map(PathBuf::from);
    Ok(weald_studio::open(Options { what, own_files, ..Options::default() })?)
}
