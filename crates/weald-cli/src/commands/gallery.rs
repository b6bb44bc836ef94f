//! `weald gallery`.

use std::path::Path;

use weald::gallery::{self, Begun};

use crate::failure::Failure;
use crate::{interrupt, stdout};

/// Seconds from which on a figure says how long it takes.
const LONG: u32 = 5;

/// Files are written whole or not at all, and the page after each figure: an interruption may end it at once.
pub(crate) fn gallery(only: &[String], out: &Path) -> Result<(), Failure> {
    interrupt::end_at_once()?;
    gallery::write(out, only, &|begun| eprintln!("{}", line(begun)))?;
    stdout::print(&format!("{}\n", out.join("index.md").display()))
}

fn line(Begun { figure, number, count }: Begun<'_>) -> String {
    let time = match figure.seconds {
        LONG.. => format!(", about {} s on two cores", figure.seconds),
        _ => String::new(),
    };
    format!("figure {number}/{count} {}{time}", figure.id)
}
