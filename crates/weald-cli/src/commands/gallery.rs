//! `weald gallery`.

use std::path::Path;

use weald::gallery;

use crate::failure::Failure;
use crate::stdout;

pub(crate) fn gallery(only: &[String], out: &Path) -> Result<(), Failure> {
    gallery::write(out, only, &|id| eprintln!("figure {id}"))?;
    stdout::print(&format!("{}\n", out.join("index.md").display()))
}
