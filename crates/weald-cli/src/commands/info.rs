//! `weald info`.

use std::path::Path;

use crate::failure::Failure;
use crate::stdout;

pub(crate) fn info(file: &Path, json: bool) -> Result<(), Failure> {
    let info = weald::io::describe(file)?;
    stdout::print(&if json { format!("{:#}\n", info.to_json()) } else { info.to_string() })
}
