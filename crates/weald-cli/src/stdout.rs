//! Results on stdout. A reader that has seen enough, such as `head`, is no failure.

use std::io::{ErrorKind, Write};

use crate::failure::Failure;

/// Prints a text that ends with a line break.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::run(format!("cannot write to stdout: {cause}")))
        }
        _ => Ok(()),
    }
}
