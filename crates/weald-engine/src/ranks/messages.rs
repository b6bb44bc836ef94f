//! What passes between ranks, by whatever means.

use std::fmt::Debug;

use super::overlap::Overlap;
use weald_core::error::Error;

/// This process among those that compute a simulation together, and how it speaks with the others.
///
/// All methods but [`Ranks::rank`], [`Ranks::count`] and [`Ranks::leads`] are collective: every rank calls the same
/// ones in the same order, and waits there for the others as far as it needs them. One thread of a process calls them
/// at a time. An error is [`Error::Run`] and means that another rank can no longer be reached; no further call
/// succeeds then.
pub trait Ranks: Debug + Send + Sync {
    /// Number of this rank, below [`Ranks::count`]. Ranks have rows from north to south by their numbers.
    fn rank(&self) -> usize;

    /// Number of ranks, at least 1.
    fn count(&self) -> usize;

    /// Whether this is the first rank, which decides what all do.
    fn leads(&self) -> bool {
        self.rank() == 0
    }

    /// Gives every rank the message of the first; what others hand in is of no account.
    fn tell(&self, message: Vec<u8>) -> Result<Vec<u8>, Error>;

    /// Gives every rank the part that the first has for it. There `part` makes those of all ranks by their numbers, its
    /// own among them, one at a time, so that no more than one is in memory; elsewhere it is not called.
    fn deal(&self, part: &mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<u8>, Error>;

    /// Gives the first rank what each has. There `take` receives the number of a rank and its part, from the first rank
    /// to the last, one at a time; elsewhere it is not called.
    ///
    /// # Errors
    /// Also the first one of `take`.
    fn collect(
        &self,
        own: Vec<u8>,
        take: &mut dyn FnMut(usize, Vec<u8>) -> Result<(), Error>,
    ) -> Result<(), Error>;

    /// Swaps numbers with other ranks, each of which swaps as many with this one in the same call. A rank that has
    /// nobody to swap with may leave the call out.
    fn swap(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error>;

    /// The same while other threads of this process compute: it waits without taking a processor from them. Others may call
    /// either.
    fn swap_aside(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        self.swap(swaps)
    }

    /// When this rank computes its inside while rows of its neighbours are on their way.
    fn overlap(&self) -> Overlap {
        Overlap::Measured
    }

    /// Gives bytes to other ranks, each of which gives some to this one in the same call, as many or not; gets theirs in the
    /// same order. A rank that has nobody to trade with may leave the call out.
    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error>;
}

/// What two ranks give each other.
#[derive(Debug)]
pub struct Swap<'a> {
    /// The other rank.
    pub with: usize,
    /// What it gets.
    pub give: &'a [f32],
    /// Where lies what comes from it; as long as what it gives.
    pub take: &'a mut [f32],
}
