//! One process that computes alone, for what is written for ranks.

use super::messages::{Ranks, Swap};
use weald_core::error::Error;

/// The only rank.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Ranks for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn count(&self) -> usize {
        1
    }

    fn tell(&self, message: Vec<u8>) -> Result<Vec<u8>, Error> {
        Ok(message)
    }

    fn deal(&self, part: &mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<u8>, Error> {
        Ok(part(0))
    }

    fn collect(
        &self,
        own: Vec<u8>,
        take: &mut dyn FnMut(usize, Vec<u8>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        take(0, own)
    }

    fn swap(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        if swaps.is_empty() { Ok(()) } else { Err(nobody()) }
    }

    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error> {
        if given.is_empty() { Ok(Vec::new()) } else { Err(nobody()) }
    }
}

/// A bug of the caller.
fn nobody() -> Error {
    Error::Run("a process alone was to send something to another".to_owned())
}
