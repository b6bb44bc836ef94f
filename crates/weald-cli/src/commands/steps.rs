//! `weald steps`.

use weald::recipe::describe;

use crate::failure::Failure;
use crate::stdout;

pub(crate) fn steps(name: Option<&str>) -> Result<(), Failure> {
    let text = match name {
        Some(name) => describe::step(name).map_err(Failure::usage)?,
        None => describe::overview(),
    };
    stdout::print(&text)
}
