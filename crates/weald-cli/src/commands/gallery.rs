//! `weald gallery`.

use std::path::Path;

use weald::Error;
use weald::picture::RenderDevice;
use weald_gallery::figures::{self as gallery, StartedFigure};
use weald_gpu::Gpu;

use crate::failure::Failure;
use crate::{interrupt, stdout};

/// Seconds from which on a figure says how long it takes.
const LONG: u32 = 5;

/// Files are written whole or not at all, and the page after each figure: an interruption may end it at once.
pub(crate) fn gallery(only: &[String], out: &Path) -> Result<(), Failure> {
    interrupt::end_at_once()?;
    let opened = gallery::draws(only).then(Gpu::for_drawing);
    let device = opened.as_ref().and_then(|opened| opened.as_ref().ok()).map(|gpu| gpu as &dyn RenderDevice);
    match (gallery::write(out, only, device, &|begun| eprintln!("{}", line(begun))), opened) {
        // A figure that needs a device says so itself, but not why there is none.
        (Err(Error::Device(figure)), Some(Err(Error::Device(why)))) => {
            return Err(Error::from(why.of(figure)).into());
        }
        (done, _) => done?,
    }
    stdout::print(&format!("{}\n", out.join("index.md").display()))
}

fn line(StartedFigure { figure, number, count }: StartedFigure<'_>) -> String {
    let time = match figure.seconds {
        LONG.. => format!(", about {} s on two cores", figure.seconds),
        _ => String::new(),
    };
    format!("figure {number}/{count} {}{time}", figure.id)
}
