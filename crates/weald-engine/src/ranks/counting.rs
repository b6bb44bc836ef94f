//! Ranks that count what they send.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Overlap, Ranks, Swap};
use weald_core::error::Error;

/// Ranks that count the exchanges with their neighbours, and the bytes that go out in them.
#[derive(Debug)]
pub struct Counting {
    ranks: Arc<dyn Ranks>,
    overlap: Overlap,
    exchanges: AtomicU64,
    aside: AtomicU64,
    bytes: AtomicU64,
}

impl Counting {
    /// The same ranks, with nothing counted yet.
    pub fn new(ranks: Arc<dyn Ranks>) -> Self {
        let overlap = ranks.overlap();
        Self::overlapping(ranks, overlap)
    }

    /// The same, which compute their inside first as is said.
    pub fn overlapping(ranks: Arc<dyn Ranks>, overlap: Overlap) -> Self {
        let [exchanges, aside, bytes] = [0; 3].map(AtomicU64::new);
        Self { ranks, overlap, exchanges, aside, bytes }
    }

    /// Exchanges of rows with one neighbour each.
    pub fn exchanges(&self) -> u64 {
        self.exchanges.load(Ordering::Relaxed)
    }

    /// Those of them that were under way while the inside was computed.
    pub fn aside(&self) -> u64 {
        self.aside.load(Ordering::Relaxed)
    }

    /// Bytes that were sent to neighbours.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    fn count_swaps(&self, swaps: &[Swap<'_>]) {
        let bytes: usize = swaps.iter().map(|swap| size_of_val(swap.give)).sum();
        self.exchanges.fetch_add(swaps.len() as u64, Ordering::Relaxed);
        self.bytes.fetch_add(bytes as u64, Ordering::Relaxed);
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
        self.count_swaps(swaps);
        self.ranks.swap(swaps)
    }

    fn swap_aside(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        self.count_swaps(swaps);
        self.aside.fetch_add(swaps.len() as u64, Ordering::Relaxed);
        self.ranks.swap_aside(swaps)
    }

    fn overlap(&self) -> Overlap {
        self.overlap
    }

    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error> {
        let bytes: usize = given.iter().map(|(_, bytes)| bytes.len()).sum();
        self.exchanges.fetch_add(given.len() as u64, Ordering::Relaxed);
        self.bytes.fetch_add(bytes as u64, Ordering::Relaxed);
        self.ranks.trade(given)
    }
}
