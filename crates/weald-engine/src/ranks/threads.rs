//! Ranks that are threads of one process: for tests, and to try on one machine what a cluster does.

use std::fmt::{Debug, Formatter};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use super::messages::{Ranks, Swap};
use weald_core::error::Error;

/// So many ranks, each for a thread of its own, that send each other messages through channels. A rank that is dropped
/// ends the others with an error as soon as they wait for it. Threads of one rayon pool are no ranks: they wait for each
/// other, and for the pool.
pub fn ranks_in_threads(count: usize) -> Vec<Arc<dyn Ranks>> {
    let count = count.max(1);
    let mut senders: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    let mut receivers: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    for own in &mut senders {
        for from in &mut receivers {
            let (sender, receiver) = channel();
            own.push(sender);
            from.push(Mutex::new(receiver));
        }
    }
    let ends = senders.into_iter().zip(receivers).enumerate();
    ends.map(|(rank, (to, from))| Arc::new(ThreadRank { rank, to, from }) as Arc<dyn Ranks>).collect()
}

/// What one rank sends another.
enum Message {
    Bytes(Vec<u8>),
    Numbers(Vec<f32>),
}

struct ThreadRank {
    rank: usize,
    /// To each rank.
    to: Vec<Sender<Message>>,
    /// From each rank.
    from: Vec<Mutex<Receiver<Message>>>,
}

impl Debug for ThreadRank {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "rank {} of {} in threads", self.rank, self.to.len())
    }
}

impl ThreadRank {
    fn send(&self, to: usize, message: Message) -> Result<(), Error> {
        self.to[to].send(message).map_err(|_| gone(to))
    }

    fn receive(&self, from: usize) -> Result<Message, Error> {
        // A panic elsewhere leaves a channel whole.
        let receiver = self.from[from].lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv().map_err(|_| gone(from))
    }

    fn receive_bytes(&self, from: usize) -> Result<Vec<u8>, Error> {
        match self.receive(from)? {
            Message::Bytes(bytes) => Ok(bytes),
            Message::Numbers(_) => Err(out_of_step(from)),
        }
    }

    fn others(&self) -> std::ops::Range<usize> {
        1..self.to.len()
    }
}

impl Ranks for ThreadRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.to.len()
    }

    fn tell(&self, message: Vec<u8>) -> Result<Vec<u8>, Error> {
        if !self.leads() {
            return self.receive_bytes(0);
        }
        self.others().try_for_each(|other| self.send(other, Message::Bytes(message.clone())))?;
        Ok(message)
    }

    fn deal(&self, part: &mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<u8>, Error> {
        if !self.leads() {
            return self.receive_bytes(0);
        }
        self.others().try_for_each(|other| self.send(other, Message::Bytes(part(other))))?;
        Ok(part(0))
    }

    fn collect(
        &self,
        own: Vec<u8>,
        take: &mut dyn FnMut(usize, Vec<u8>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if !self.leads() {
            return self.send(0, Message::Bytes(own));
        }
        take(0, own)?;
        self.others().try_for_each(|other| take(other, self.receive_bytes(other)?))
    }

    fn swap(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        for swap in &*swaps {
            self.send(swap.with, Message::Numbers(swap.give.to_vec()))?;
        }
        for swap in swaps {
            match self.receive(swap.with)? {
                Message::Numbers(numbers) if numbers.len() == swap.take.len() => {
                    swap.take.copy_from_slice(&numbers);
                }
                _ => return Err(out_of_step(swap.with)),
            }
        }
        Ok(())
    }

    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error> {
        let others: Vec<usize> = given.iter().map(|(with, _)| *with).collect();
        given.into_iter().try_for_each(|(with, bytes)| self.send(with, Message::Bytes(bytes)))?;
        others.into_iter().map(|with| self.receive_bytes(with)).collect()
    }
}

fn gone(rank: usize) -> Error {
    Error::Run(format!("rank {rank} has ended before the run did"))
}

/// A bug: two ranks have called different methods.
fn out_of_step(rank: usize) -> Error {
    Error::Run(format!("rank {rank} sent what was not expected: it is at another place of the run"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each rank's result, in order.
    fn each<T: Send>(count: usize, work: impl Fn(&dyn Ranks) -> T + Sync) -> Vec<T> {
        let ranks = ranks_in_threads(count);
        let work = &work;
        std::thread::scope(|scope| {
            let running: Vec<_> = ranks.into_iter().map(|rank| scope.spawn(move || work(&*rank))).collect();
            running.into_iter().map(|rank| rank.join().expect("no panic")).collect()
        })
    }

    #[test]
    fn what_one_rank_has_arrives_where_it_should() {
        let got = each(3, |ranks| {
            let own = ranks.rank() as u8;
            let told = ranks.tell(vec![own, 7]).expect("all are there");
            let dealt = ranks.deal(&mut |rank| vec![10 + rank as u8]).expect("all are there");
            let mut seen = Vec::new();
            let take = &mut |rank: usize, part: Vec<u8>| {
                seen.push((rank, part));
                Ok(())
            };
            ranks.collect(vec![own; 2], take).expect("all are there");
            let (mut from, give) = ([0.0], [f32::from(own)]);
            let with = [1, 0, 2][ranks.rank()];
            if with != ranks.rank() {
                ranks.swap(&mut [Swap { with, give: &give, take: &mut from }]).expect("both are there");
            }
            let traded =
                if with == ranks.rank() { Vec::new() } else { vec![(with, vec![own; ranks.rank()])] };
            let traded = ranks.trade(traded).expect("both are there");
            (told, dealt, seen, (from[0], traded))
        });
        assert!(got.iter().all(|(told, ..)| told == &[0, 7]), "the first rank's word counts");
        assert_eq!(got.iter().map(|(_, dealt, ..)| dealt[0]).collect::<Vec<_>>(), [10, 11, 12]);
        assert_eq!(got[0].2, [(0, vec![0, 0]), (1, vec![1, 1]), (2, vec![2, 2])]);
        assert!(got[1].2.is_empty() && got[2].2.is_empty());
        assert_eq!(got.iter().map(|(.., (from, _))| *from).collect::<Vec<_>>(), [1.0, 0.0, 0.0]);
        let traded: Vec<_> = got.iter().map(|(.., (_, traded))| traded.clone()).collect();
        assert_eq!(traded, [vec![vec![1]], vec![vec![]], vec![]], "of any length");
    }

    #[test]
    fn a_rank_that_ends_early_ends_those_that_wait_for_it() {
        let ends = each(3, |ranks| if ranks.rank() == 0 { Ok(Vec::new()) } else { ranks.tell(Vec::new()) });
        let said = |end: &Result<_, Error>| end.as_ref().err().map(ToString::to_string);
        assert_eq!(said(&ends[1]).as_deref(), Some("rank 0 has ended before the run did"));
        assert!(said(&ends[2]).is_some());
    }
}
