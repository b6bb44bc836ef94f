//! One simulation over ranks: processes, each with a band of rows in memory of its own, that compute it together.
//!
//! The first rank leads: it runs the step as on any other engine, on a [machine](crate::machine::Machine) that tells the
//! others what to do. They begin the same step, by which they have the same process, and then [`follow`]. A rank holds
//! the state of its own rows and of those around them that its cells feel in the steps between two exchanges; before
//! them it gets these rows from its neighbours. So a cell becomes what it becomes in the whole, to the bit, and sums,
//! which each row has, are added from north to south by the first rank, whatever the number of ranks.

mod band;
mod bytes;
mod command;
mod counting;
mod follower;
mod leader;
mod messages;
mod share;
mod threads;

pub use counting::Counting;
pub use follower::follow;
pub(crate) use leader::RanksMachine;
pub use messages::{Ranks, Swap};
pub use threads::ranks_in_threads;
