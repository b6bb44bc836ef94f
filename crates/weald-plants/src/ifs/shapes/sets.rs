//! 2D figures that mathematicians drew first.

use super::super::system::Role::{Branch, Trunk};
use super::shape::{Maps, Shape};

const THIRD: f64 = 1.0 / 3.0;

pub(super) const GASKET: Shape = Shape {
    name: "gasket",
    summary: "Sierpinski's gasket on a right triangle",
    source: "Sierpiński 1915; Han and Kim 2007, eq. 2",
    code_digits: 24,
    maps: Maps::Planar(&[
        ([0.5, 0.0, 0.0, 0.5, 0.0, 0.0], THIRD, Branch),
        ([0.5, 0.0, 0.0, 0.5, 0.5, 0.0], THIRD, Branch),
        ([0.5, 0.0, 0.0, 0.5, 0.0, 0.5], THIRD, Branch),
    ]),
};

pub(super) const DRAGON: Shape = Shape {
    name: "dragon",
    summary: "Heighway's dragon, a strip of paper folded for ever",
    source: "Davis and Knuth 1970, Number representations and dragon curves",
    code_digits: 48,
    maps: Maps::Planar(&[
        ([0.5, -0.5, 0.5, 0.5, 0.0, 0.0], 0.5, Branch),
        ([-0.5, -0.5, 0.5, -0.5, 1.0, 0.0], 0.5, Branch),
    ]),
};

pub(super) const CARPET: Shape = Shape {
    name: "carpet",
    summary: "Sierpinski's carpet: eight of nine squares",
    source: "Sierpiński 1916",
    code_digits: 24,
    maps: Maps::Planar(&[
        ([THIRD, 0.0, 0.0, THIRD, 0.0, 0.0], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, THIRD, 0.0], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, 2.0 * THIRD, 0.0], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, 0.0, THIRD], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, 2.0 * THIRD, THIRD], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, 0.0, 2.0 * THIRD], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, THIRD, 2.0 * THIRD], 0.125, Branch),
        ([THIRD, 0.0, 0.0, THIRD, 2.0 * THIRD, 2.0 * THIRD], 0.125, Branch),
    ]),
};

pub(super) const SPIRAL: Shape = Shape {
    name: "spiral",
    summary: "a spiral of spirals, as in a shell",
    source: "Weald",
    code_digits: 128,
    maps: Maps::Planar(&[
        ([0.834, -0.389, 0.389, 0.834, 0.0, 0.0], 0.88, Trunk),
        ([0.26, 0.15, -0.15, 0.26, 1.0, 0.0], 0.12, Branch),
    ]),
};
