//! The figures of Han and Kim 2007, "Fractal deformation using code and displacement vectors", one constant each, with
//! the source's intervals and vectors. What its A, its angles and its factors were is lost; ours are stated.

mod code_method;
mod codes;
mod fields;
mod panels;
mod parts;
mod vectors;

pub(super) use code_method::{FIGURE_5, FIGURE_6, FIGURE_7, FIGURE_8, FIGURE_9, FIGURE_10};
pub(super) use codes::{FIGURE_1, FIGURE_2, FIGURE_15};
pub(super) use fields::{FIGURE_3, FIGURE_4};
pub(super) use parts::FIGURE_16;
pub(super) use vectors::{FIGURE_11, FIGURE_12, FIGURE_13, FIGURE_14};

/// A of the source's field, eq. 6, which is lost.
const AMPLITUDE: f64 = 0.4;
