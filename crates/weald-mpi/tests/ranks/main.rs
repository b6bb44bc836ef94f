//! `weald-mpi` under a local `mpirun`: files, reports, ends and resumed runs are those of one processor.

mod distributed;
mod ends;
mod hosts;
mod launched;
mod page;
mod same_bits;
mod scaling;
