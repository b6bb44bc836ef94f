//! One simulation over ranks: processes, each with a band of rows in memory of its own, that compute it together.
//!
//! In lockstep the first rank leads: it runs the step as on any other engine, on a [machine](crate::machine::Machine) that
//! tells the others what to do. They begin the same step, by which they have the same process, and then [`follow`]. A rank
//! holds the state of its own rows and of those around them that its cells feel in the steps between two exchanges; before
//! them it gets these rows from its neighbours. So a cell becomes what it becomes in the whole, to the bit, and sums,
//! which each row has, are added from north to south by the first rank, whatever the number of ranks.
//!
//! Where no rank holds the whole, all run the same program on a [landscape](crate::stored::StoredLandscape) of which each
//! has its [own rows](SharedRows), and [agree](agreed) between its parts.

mod agreement;
mod alone;
mod band;
mod border;
mod bytes;
mod command;
mod counting;
mod follower;
mod leader;
mod messages;
mod overlap;
mod share;
mod shared_rows;
mod threads;

pub use agreement::{agreed, any, greatest, joined, least, total};
pub use alone::Alone;
pub use bytes::{Reader, Writer};
pub use counting::Counting;
pub use follower::follow;
pub(crate) use leader::RanksMachine;
pub use messages::{Ranks, Swap};
pub use overlap::Overlap;
pub use shared_rows::SharedRows;
pub use threads::ranks_in_threads;
