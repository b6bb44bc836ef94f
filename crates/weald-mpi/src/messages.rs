//! Messages between ranks by MPI. An error of MPI ends the program on all ranks, which is what MPI does with errors.

use std::time::Duration;

use mpi::collective::Root;
use mpi::point_to_point::{Destination, Source};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Equivalence};
use weald::Error;
use weald::engine::ranks::{Overlap, Ranks, Swap};

/// Most values of one message: MPI counts them in 31 bits.
const PIECE: usize = 1 << 28;

/// How long a rank that computes sleeps before it looks again for what has come.
const LOOKS_EVERY: Duration = Duration::from_micros(50);

/// The processes that were started together.
#[derive(Debug)]
pub(crate) struct MpiRanks {
    rank: usize,
    count: usize,
    overlap: Overlap,
}

impl MpiRanks {
    /// MPI has been initialised.
    pub(crate) fn new(overlap: Overlap) -> Self {
        let world = SimpleCommunicator::world();
        Self { rank: world.rank() as usize, count: world.size() as usize, overlap }
    }
}

/// How many of the ranks are on this machine.
pub(crate) fn ranks_of_this_machine() -> usize {
    SimpleCommunicator::world().split_shared(0).size() as usize
}

fn send<T: Equivalence>(world: &SimpleCommunicator, to: usize, values: &[T]) {
    let to = world.process_at_rank(to as i32);
    to.send(&[values.len() as u64]);
    values.chunks(PIECE).for_each(|piece| to.send(piece));
}

fn receive(world: &SimpleCommunicator, from: usize) -> Vec<u8> {
    let from = world.process_at_rank(from as i32);
    let mut length = [0_u64];
    from.receive_into(&mut length);
    let mut bytes = vec![0; length[0] as usize];
    bytes.chunks_mut(PIECE).for_each(|piece| {
        from.receive_into(piece);
    });
    bytes
}

impl Ranks for MpiRanks {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    fn tell(&self, message: Vec<u8>) -> Result<Vec<u8>, Error> {
        let world = SimpleCommunicator::world();
        let first = world.process_at_rank(0);
        let mut length = [message.len() as u64];
        first.broadcast_into(&mut length);
        let mut message = if self.leads() { message } else { vec![0; length[0] as usize] };
        message.chunks_mut(PIECE).for_each(|piece| first.broadcast_into(piece));
        Ok(message)
    }

    fn deal(&self, part: &mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<u8>, Error> {
        let world = SimpleCommunicator::world();
        if !self.leads() {
            return Ok(receive(&world, 0));
        }
        (1..self.count).for_each(|rank| send(&world, rank, &part(rank)));
        Ok(part(0))
    }

    fn collect(
        &self,
        own: Vec<u8>,
        take: &mut dyn FnMut(usize, Vec<u8>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let world = SimpleCommunicator::world();
        if !self.leads() {
            send(&world, 0, &own);
            return Ok(());
        }
        take(0, own)?;
        (1..self.count).try_for_each(|rank| take(rank, receive(&world, rank)))
    }

    fn swap(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        swap_all(&SimpleCommunicator::world(), buffers(swaps), false);
        Ok(())
    }

    fn swap_aside(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        swap_all(&SimpleCommunicator::world(), buffers(swaps), true);
        Ok(())
    }

    fn overlap(&self) -> Overlap {
        self.overlap
    }

    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error> {
        let world = SimpleCommunicator::world();
        let lengths: Vec<_> = given.iter().map(|(_, bytes)| [bytes.len() as u64]).collect();
        let mut coming = vec![[0_u64]; given.len()];
        let with = given.iter().map(|(with, _)| *with);
        let counts = with.zip(&lengths).zip(&mut coming);
        swap_all(
            &world,
            counts.map(|((with, give), take)| (with, give.as_slice(), take.as_mut_slice())),
            false,
        );
        let mut taken: Vec<Vec<u8>> = coming.iter().map(|[length]| vec![0; *length as usize]).collect();
        let bytes = given.iter().zip(&mut taken);
        swap_all(
            &world,
            bytes.map(|((with, give), take)| (*with, give.as_slice(), take.as_mut_slice())),
            false,
        );
        Ok(taken)
    }
}

fn buffers<'a>(swaps: &'a mut [Swap<'_>]) -> impl Iterator<Item = (usize, &'a [f32], &'a mut [f32])> {
    swaps.iter_mut().map(|Swap { with, give, take }| (*with, *give, &mut **take))
}

/// Gives and takes; all messages are under way at the same time. `aside` of what other threads compute, it looks now and then
/// what has come, since MPI may move a message only then, and a wait would take a processor from them.
fn swap_all<'a, T: Equivalence + 'a>(
    world: &SimpleCommunicator,
    swaps: impl Iterator<Item = (usize, &'a [T], &'a mut [T])>,
    aside: bool,
) {
    mpi::request::scope(|scope| {
        let (mut pending, mut going) = (Vec::new(), Vec::new());
        for (with, give, take) in swaps {
            let other = world.process_at_rank(with as i32);
            for piece in take.chunks_mut(PIECE) {
                pending.push(other.immediate_receive_into(scope, piece));
            }
            for piece in give.chunks(PIECE) {
                going.push(other.immediate_send(scope, piece));
            }
        }
        pending.extend(going);
        while aside && !pending.is_empty() {
            pending = pending.into_iter().filter_map(|request| request.test().err()).collect();
            std::thread::sleep(LOOKS_EVERY);
        }
        for request in pending {
            request.wait();
        }
    });
}
