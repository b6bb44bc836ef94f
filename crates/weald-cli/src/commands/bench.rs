//! `weald bench`.

use crate::failure::Failure;
use crate::stdout;

pub(crate) fn bench(sizes: &[usize], threads: &[usize]) -> Result<(), Failure> {
    let mut unwritten = None;
    weald::bench::run(sizes, threads, &mut |rate| {
        if let Err(failure) = stdout::print(&format!("{rate}\n")) {
            unwritten = Some(failure);
        }
    })?;
    unwritten.map_or(Ok(()), Err)
}
