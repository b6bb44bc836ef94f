//! What grows on the land: plants from the codes of fractals.

pub mod ifs;
