//! 3D plants and figures, `y` up and rooted at the origin.

use super::super::system::Role::{Branch, Stem, Trunk};
use super::shape::{Maps, Shape};

pub(super) const FERN: Shape = Shape {
    name: "fern-3d",
    summary: "Barnsley's fern in 3D: its frond arches forward and its leaves stand off it",
    source: "Barnsley 1988, Fractals everywhere, plate and section III.9, as in public tables",
    code_digits: 64,
    maps: Maps::Spatial(&[
        ([[0.0, 0.0, 0.0, 0.0], [0.0, 0.18, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]], 0.01, Stem),
        ([[0.85, 0.0, 0.0, 0.0], [0.0, 0.85, 0.1, 1.6], [0.0, -0.1, 0.85, 0.0]], 0.85, Trunk),
        ([[0.2, -0.2, 0.0, 0.0], [0.2, 0.2, 0.0, 0.8], [0.0, 0.0, 0.3, 0.0]], 0.07, Branch),
        ([[-0.2, 0.2, 0.0, 0.0], [0.2, 0.2, 0.0, 0.8], [0.0, 0.0, 0.3, 0.0]], 0.07, Branch),
    ]),
};

/// Each whorl turns by the golden angle on the one below, and its three boughs reach out and hang a little.
pub(super) const CONIFER: Shape = Shape {
    name: "conifer",
    summary: "an airy conifer: whorls of three hanging boughs that shrink to the top",
    source: "Weald",
    code_digits: 64,
    maps: Maps::Spatial(&[
        ([[0.02, 0.0, 0.0, 0.0], [0.0, 0.16, 0.0, 0.0], [0.0, 0.0, 0.02, 0.0]], 0.04, Stem),
        (
            [[-0.648_9, 0.0, 0.594_4, 0.0], [0.0, 0.88, 0.0, 0.12], [-0.594_4, 0.0, -0.648_9, 0.0]],
            0.66,
            Trunk,
        ),
        ([[0.0, 0.34, 0.0, 0.0], [-0.26, -0.09, 0.0, 0.1], [0.0, 0.0, 0.3, 0.0]], 0.10, Branch),
        ([[0.0, -0.17, -0.26, 0.0], [-0.26, -0.09, 0.0, 0.1], [0.0, 0.294_4, -0.15, 0.0]], 0.10, Branch),
        ([[0.0, -0.17, 0.26, 0.0], [-0.26, -0.09, 0.0, 0.1], [0.0, -0.294_4, -0.15, 0.0]], 0.10, Branch),
    ]),
};

/// Dense whorls of five flat boughs, each of which hangs and bears sprays to both sides.
pub(super) const SPRUCE: Shape = Shape {
    name: "spruce",
    summary: "a dense spruce: whorls of five flat boughs that hang, down to the ground",
    source: "Weald",
    code_digits: 64,
    maps: Maps::Spatial(&[
        ([[0.02, 0.0, 0.0, 0.0], [0.0, 0.11, 0.0, 0.0], [0.0, 0.0, 0.02, 0.0]], 0.04, Stem),
        ([[-0.663_5, 0.0, 0.608, 0.0], [0.0, 0.9, 0.0, 0.1], [-0.608, 0.0, -0.663_5, 0.0]], 0.71, Trunk),
        ([[0.0, 0.33, 0.0, 0.0], [-0.22, -0.12, 0.0, 0.04], [0.0, 0.0, 0.62, 0.0]], 0.05, Branch),
        (
            [[0.0, 0.102, 0.589_7, 0.0], [-0.22, -0.12, 0.0, 0.06], [0.0, -0.313_8, 0.191_6, 0.0]],
            0.05,
            Branch,
        ),
        (
            [[0.0, -0.267, 0.364_4, 0.0], [-0.22, -0.12, 0.0, 0.08], [0.0, -0.194, -0.501_6, 0.0]],
            0.05,
            Branch,
        ),
        (
            [[0.0, -0.267, -0.364_4, 0.0], [-0.22, -0.12, 0.0, 0.07], [0.0, 0.194, -0.501_6, 0.0]],
            0.05,
            Branch,
        ),
        (
            [[0.0, 0.102, -0.589_7, 0.0], [-0.22, -0.12, 0.0, 0.05], [0.0, 0.313_8, 0.191_6, 0.0]],
            0.05,
            Branch,
        ),
    ]),
};

/// Four boughs a quarter turn apart on two heights, and the leader that goes on upward.
pub(super) const CROWN: Shape = Shape {
    name: "crown",
    summary: "a broad 3D tree: a leader and four boughs, each a tree again",
    source: "Weald",
    code_digits: 64,
    maps: Maps::Spatial(&[
        ([[0.04, 0.0, 0.0, 0.0], [0.0, 0.4, 0.0, 0.0], [0.0, 0.0, 0.04, 0.0]], 0.04, Stem),
        ([[0.0, 0.08, 0.62, 0.0], [0.0, 0.62, -0.08, 0.38], [-0.62, 0.0, 0.0, 0.0]], 0.26, Trunk),
        ([[0.36, 0.42, 0.0, 0.0], [-0.42, 0.36, 0.0, 0.3], [0.0, 0.0, 0.54, 0.0]], 0.18, Branch),
        ([[-0.36, -0.42, 0.0, 0.0], [-0.42, 0.36, 0.0, 0.34], [0.0, 0.0, -0.54, 0.0]], 0.18, Branch),
        ([[0.0, 0.0, 0.54, 0.0], [-0.4, 0.34, 0.0, 0.38], [-0.34, -0.4, 0.0, 0.0]], 0.17, Branch),
        ([[0.0, 0.0, -0.54, 0.0], [-0.4, 0.34, 0.0, 0.36], [0.34, 0.4, 0.0, 0.0]], 0.17, Branch),
    ]),
};

pub(super) const TETRAHEDRON: Shape = Shape {
    name: "tetrahedron",
    summary: "Sierpinski's gasket in 3D",
    source: "Sierpiński 1915, one dimension further",
    code_digits: 24,
    maps: Maps::Spatial(&[
        ([[0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.5, 0.0]], 0.25, Branch),
        ([[0.5, 0.0, 0.0, 0.5], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.5, 0.0]], 0.25, Branch),
        ([[0.5, 0.0, 0.0, 0.25], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.5, 0.433_012_7]], 0.25, Branch),
        ([[0.5, 0.0, 0.0, 0.25], [0.0, 0.5, 0.0, 0.408_248_3], [0.0, 0.0, 0.5, 0.144_337_57]], 0.25, Branch),
    ]),
};
