//! What grows on the land: plants from the codes of fractals, and where they stand.

pub mod ifs;
pub mod scatter;
