//! Ctrl-C and SIGTERM: the first rank ends the run after a checkpoint, the others follow it; of a distributed run all end so at
//! the next place where they meet.

use std::sync::atomic::{AtomicBool, Ordering};

use weald::Error;

const INTERRUPTED: i32 = 130;

/// What the first rank says. Open MPI waits five seconds where nothing else is asked for.
const AFTER_A_CHECKPOINT: &str = "stopping after a checkpoint, for which mpirun gives 5 s, or as long as --mca odls_base_sigkill_timeout says; if there is no \
     time for it or a rank was lost, the last one stands, and the same command with --resume goes on from it";

static ASKED: AtomicBool = AtomicBool::new(false);

/// Listens from now on. A launcher sends the signal to all ranks, also where one of them is lost: then the others wait for
/// it in vain, and the launcher ends them.
pub(crate) fn listen(leads: bool) -> Result<(), Error> {
    let handler = move || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
        if leads {
            eprintln!("{AFTER_A_CHECKPOINT}");
        }
    };
    let fault = |cause| Error::Run(format!("cannot listen for Ctrl-C and SIGTERM: {cause}"));
    ctrlc::set_handler(handler).map_err(fault)
}

/// Whether somebody has asked for an end.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
