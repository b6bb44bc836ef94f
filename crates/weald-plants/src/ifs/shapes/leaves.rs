//! 2D leaves; map 0 is the stalk.

use super::super::system::Role::{Branch, Stem, Trunk};
use super::shape::{Maps, Shape};

pub(super) const MAPLE: Shape = Shape {
    name: "maple",
    summary: "a maple leaf of three lobes",
    source: "public tables of the collage theorem, after Barnsley 1988",
    code_digits: 64,
    maps: Maps::Planar(&[
        ([0.14, 0.01, 0.0, 0.51, -0.08, -1.31], 0.10, Stem),
        ([0.43, 0.52, -0.45, 0.50, 1.49, -0.75], 0.35, Branch),
        ([0.45, -0.49, 0.47, 0.47, -1.62, -0.74], 0.35, Branch),
        ([0.49, 0.0, 0.0, 0.51, 0.02, 1.62], 0.20, Trunk),
    ]),
};

pub(super) const SKELETON: Shape = Shape {
    name: "skeleton",
    summary: "the veins of a leaf that winter has eaten",
    source: "Weald",
    code_digits: 64,
    maps: Maps::Planar(&[
        ([0.02, 0.0, 0.0, 0.3, 0.0, 0.0], 0.04, Stem),
        ([0.74, 0.02, -0.02, 0.74, 0.0, 0.26], 0.50, Trunk),
        ([0.3, -0.34, 0.3, 0.3, 0.0, 0.14], 0.23, Branch),
        ([-0.3, 0.34, 0.3, 0.3, 0.0, 0.18], 0.23, Branch),
    ]),
};
