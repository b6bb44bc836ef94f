//! The [figures] of the publications that Weald implements, made again and measured, and [rates](mod@bench) of its methods
//! beside what limits them.

pub mod bench;
pub mod figures;
