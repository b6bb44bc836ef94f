//! `weald studio`.

use std::path::{Path, PathBuf};

use weald_studio::Options;

use crate::failure::Failure;

pub(crate) fn studio(what: Option<PathBuf>, trace: Option<&Path>) -> Result<(), Failure> {
    let _trace = trace.map(weald_studio::record).transpose()?;
    let own_files = std::env::var_os("WEALD_STATE").map(PathBuf::from);
    Ok(weald_studio::open(Options { what, own_files, ..Options::default() })?)
}
