//! 2D ferns. Map 0 is the stem, 1 goes on upward, 2 and 3 are the lowest fronds left and right.

use super::super::system::Role::{Branch, Stem, Trunk};
use super::shape::{Maps, Shape};

pub(super) const FERN: Shape = Shape {
    name: "fern",
    summary: "Barnsley's fern, a black spleenwort",
    source: "Barnsley 1988, Fractals everywhere, table III.3",
    code_digits: 64,
    maps: Maps::Planar(&[
        ([0.0, 0.0, 0.0, 0.16, 0.0, 0.0], 0.01, Stem),
        ([0.85, 0.04, -0.04, 0.85, 0.0, 1.6], 0.85, Trunk),
        ([0.2, -0.26, 0.23, 0.22, 0.0, 1.6], 0.07, Branch),
        ([-0.15, 0.28, 0.26, 0.24, 0.0, 0.44], 0.07, Branch),
    ]),
};

pub(super) const CYCLOSORUS: Shape = Shape {
    name: "cyclosorus",
    summary: "a marsh fern with narrow fronds in pairs",
    source: "a mutation of Barnsley's fern after Vyšinský; Wikipedia, Barnsley fern",
    code_digits: 128,
    maps: Maps::Planar(&[
        ([0.0, 0.0, 0.0, 0.25, 0.0, -0.4], 0.02, Stem),
        ([0.95, 0.005, -0.005, 0.93, -0.002, 0.5], 0.84, Trunk),
        ([0.035, -0.2, 0.16, 0.04, -0.09, 0.02], 0.07, Branch),
        ([-0.04, 0.2, 0.16, 0.04, 0.083, 0.12], 0.07, Branch),
    ]),
};

pub(super) const CULCITA: Shape = Shape {
    name: "culcita",
    summary: "a tree fern's frond, feathery and wide",
    source: "a mutation of Barnsley's fern; public tables of fern variants",
    code_digits: 64,
    maps: Maps::Planar(&[
        ([0.0, 0.0, 0.0, 0.25, 0.0, -0.14], 0.02, Stem),
        ([0.85, 0.02, -0.02, 0.83, 0.0, 1.0], 0.84, Trunk),
        ([0.09, -0.28, 0.3, 0.11, 0.0, 0.6], 0.07, Branch),
        ([-0.09, 0.28, 0.3, 0.09, 0.0, 0.7], 0.07, Branch),
    ]),
};

pub(super) const FISHBONE: Shape = Shape {
    name: "fishbone",
    summary: "a sword fern: one row of slim leaflets on each side",
    source: "a mutation of Barnsley's fern; public tables of fern variants",
    code_digits: 128,
    maps: Maps::Planar(&[
        ([0.0, 0.0, 0.0, 0.25, 0.0, -0.4], 0.02, Stem),
        ([0.95, 0.002, -0.002, 0.93, -0.002, 0.5], 0.84, Trunk),
        ([0.035, -0.11, 0.27, 0.01, -0.05, 0.005], 0.07, Branch),
        ([-0.04, 0.11, 0.27, 0.01, 0.047, 0.06], 0.07, Branch),
    ]),
};
