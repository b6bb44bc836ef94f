//! 2D trees, rooted at the origin.

use super::super::system::Role::{Branch, Stem, Trunk};
use super::shape::{Maps, Shape};

pub(super) const TREE: Shape = Shape {
    name: "tree",
    summary: "Barnsley's tree: two boughs at right angles, and twigs between them",
    source: "Barnsley 1988, Fractals everywhere, table III.4",
    code_digits: 64,
    maps: Maps::Planar(&[
        ([0.0, 0.0, 0.0, 0.5, 0.0, 0.0], 0.05, Stem),
        ([0.42, -0.42, 0.42, 0.42, 0.0, 0.2], 0.40, Branch),
        ([0.42, 0.42, -0.42, 0.42, 0.0, 0.2], 0.40, Branch),
        ([0.1, 0.0, 0.0, 0.1, 0.0, 0.2], 0.15, Trunk),
    ]),
};

pub(super) const SHRUB: Shape = Shape {
    name: "shrub",
    summary: "a leaning shrub whose branches leave their stem in turn",
    source: "Weald",
    code_digits: 64,
    maps: Maps::Planar(&[
        ([0.03, 0.0, 0.0, 0.45, 0.0, 0.0], 0.05, Stem),
        ([0.66, -0.14, 0.14, 0.66, 0.0, 0.45], 0.38, Trunk),
        ([0.36, -0.36, 0.36, 0.36, 0.0, 0.22], 0.21, Branch),
        ([0.4, 0.36, -0.36, 0.4, 0.0, 0.32], 0.24, Branch),
        ([0.22, 0.3, -0.3, 0.22, 0.0, 0.42], 0.12, Branch),
    ]),
};
