//! `weald schema`.

use crate::failure::Failure;
use crate::stdout;

pub(crate) fn schema() -> Result<(), Failure> {
    stdout::print(&format!("{:#}\n", weald::recipe::schema::schema()))
}
