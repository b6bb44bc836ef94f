//! Ctrl-C and SIGTERM: the first asks for a clean end, the second ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;

const INTERRUPTED: i32 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Ends the command at the first of them, for what leaves nothing half done.
pub(crate) fn end_at_once() -> Result<(), Failure> {
    handle(|| std::process::exit(INTERRUPTED))
}

/// Listens from now on.
pub(crate) fn listen() -> Result<(), Failure> {
    handle(|| ask("stopping after a checkpoint; once more to stop at once"))
}

/// Listens for a command that keeps no checkpoints.
pub(crate) fn listen_without_checkpoint() -> Result<(), Failure> {
    handle(|| ask("stopping; once more to stop at once"))
}

fn ask(answer: &str) {
    if ASKED.swap(true, Ordering::Relaxed) {
        std::process::exit(INTERRUPTED);
    }
    eprintln!("{answer}");
}

fn handle(handler: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(handler).map_err(|cause| Failure::run(format!("cannot listen for Ctrl-C: {cause}")))
}

/// Whether the user has asked for an end.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
