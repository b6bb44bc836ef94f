//! Ranks that count what they send.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Ranks, Swap};
use weald_core::error::Error;

/// Ranks that count the exchanges with their neighbours, and the bytes that go out in them.
#[derive(Debug)]
pub struct Counting {
    ranks: Arc<dyn Ranks>,
    exchanges: AtomicU64,
    bytes: AtomicU64,
}

impl Counting {
    /// The same ranks, with nothing counted yet.
    pub fn new(ranks: Arc<dyn Ranks>) -> Self {
        Self { ranks, exchanges: AtomicU64::new(0), bytes: AtomicU64::new(0) }
    }

    /// Exchanges of rows with one neighbour each.
    pub fn exchanges(&self) -> u64 {
        self.exchanges.load(Ordering::Relaxed)
    }

    /// Bytes that were sent to neighbours.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }
}

impl Ranks for Counting {
    fn rank(&self) -> usize {
        self.ranks.rank()
    }

    fn count(&self) -> usize {
        self.ranks.count()
    }

    fn tell(&self, message: Vec<u8>) -> Result<Vec<u8>, Error> {
        self.ranks.tell(message)
    }

    fn deal(&self, part: &mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<u8>, Error> {
        self.ranks.deal(part)
    }

    fn collect(
        &self,
        own: Vec<u8>,
        take: &mut dyn FnMut(usize, Vec<u8>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.ranks.collect(own, take)
    }

    fn swap(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        let bytes: usize = swaps.iter().map(|swap| size_of_val(swap.give)).sum();
        self.exchanges.fetch_add(swaps.len() as u64, Ordering::Relaxed);
        self.bytes.fetch_add(bytes as u64, Ordering::Relaxed);
        self.ranks.swap(swaps)
    }

    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error> {
        let bytes: usize = given.iter().map(|(_, bytes)| bytes.len()).sum();
        self.exchanges.fetch_add(given.len() as u64, Ordering::Relaxed);
        self.bytes.fetch_add(bytes as u64, Ordering::Relaxed);
        self.ranks.trade(given)
    }
}
