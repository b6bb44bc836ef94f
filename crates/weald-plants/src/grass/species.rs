//! Kinds of grass: each answers to soil and light by curves of its own, and has its own sizes, colours and seed heads.
//!
//! Heights, widths and what bears a head follow Hubbard 1984, "Grasses", and Rothmaler's flora in round numbers.

use super::curves::Curves;

/// A kind of grass.
#[derive(Clone, Debug, PartialEq)]
pub struct Species {
    /// Its name in recipes.
    pub name: &'static str,
    /// What soil and light do to it.
    pub curves: Curves,
    /// Metres that a straight blade of level 4 is high where β is 1. On most ground blades are about half as high.
    pub height: f32,
    /// Metres that a blade is wide where α is 1/4.
    pub width: f32,
    /// Metres from the middle of a set to its outermost root.
    pub spread: f32,
    /// Share of the bend θ that its blades make, 0 to 1: reeds stand, fescue arches.
    pub bending: f32,
    /// Radians from upright at which blades leave the ground at most, each by chance, 0 to π/4. 0, as in the source: all stand upright there.
    pub splay: f32,
    /// How stiff its blades are in the wind; 1 is a meadow's.
    pub stiffness: f32,
    /// How much narrower a blade is at its tip: 0 not at all, as in the source, 1 is a point.
    pub taper: f32,
    /// Slope of the two halves of a blade, which lie in a groove: 0 is flat.
    pub fold: f32,
    /// Share by which the blades of a set differ in height and bend, 0 to 1.
    pub variation: f32,
    /// Blades of a set that are stalks with a head, 0 to 6.
    pub heads: u32,
    /// How much higher than a blade a stalk is.
    pub stalk: f32,
    /// Share of the stalk, from its tip, that the head takes.
    pub head_length: f32,
    /// Metres that a ripe head is wide.
    pub head_width: f32,
    /// Colour on good ground in good light, in linear light from 0 to 1.
    pub good: [f32; 3],
    /// Colour on bad ground, in linear light.
    pub bad: [f32; 3],
    /// Colour of the heads, in linear light.
    pub head: [f32; 3],
}

/// Vectors of four that a device is given for a species.
pub const ROWS: usize = 9;

/// Most species of a landscape: what four bits of an instance can name.
pub const MAX_SPECIES: usize = 16;

/// The built-in species.
pub static SPECIES: [Species; 5] = [
    Species {
        name: "ryegrass",
        curves: Curves::OF_THE_SOURCE,
        height: 0.7,
        width: 0.006,
        spread: 0.05,
        bending: 1.0,
        splay: 0.6,
        stiffness: 1.0,
        taper: 1.0,
        fold: 0.25,
        variation: 0.35,
        heads: 0,
        stalk: 1.0,
        head_length: 0.0,
        head_width: 0.0,
        good: [0.078, 0.233, 0.02],
        bad: [0.342, 0.319, 0.073],
        head: [0.448, 0.393, 0.147],
    },
    // A tuft of threads that does well on poor, sunny ground and gains little from a better one.
    Species {
        name: "fescue",
        curves: Curves::fixed([0.45, 0.7, 0.75], [0.2, 0.25, 0.3, 0.4, 0.45], [0.35, 0.55, 0.7, 0.85, 0.7]),
        height: 0.32,
        width: 0.0022,
        spread: 0.035,
        bending: 0.55,
        splay: 0.75,
        stiffness: 1.6,
        taper: 0.7,
        fold: 0.6,
        variation: 0.5,
        heads: 1,
        stalk: 2.0,
        head_length: 0.22,
        head_width: 0.009,
        good: [0.133, 0.233, 0.107],
        bad: [0.393, 0.355, 0.163],
        head: [0.42, 0.296, 0.147],
    },
    // Stands in mud at the water's edge, tall and stiff, with broad leaves and a brown plume.
    Species {
        name: "reed",
        curves: Curves::fixed([0.2, 0.5, 1.0], [0.2, 0.4, 0.6, 0.9, 1.0], [0.5, 0.65, 0.8, 0.95, 0.9]),
        height: 3.2,
        width: 0.03,
        spread: 0.14,
        bending: 0.45,
        splay: 0.15,
        stiffness: 3.0,
        taper: 1.0,
        fold: 0.35,
        variation: 0.3,
        heads: 1,
        stalk: 1.15,
        head_length: 0.24,
        head_width: 0.085,
        good: [0.107, 0.214, 0.04],
        bad: [0.448, 0.342, 0.119],
        head: [0.147, 0.078, 0.051],
    },
    // Steppe: grey-green threads, and stalks whose long silver awns bend over.
    Species {
        name: "feather-grass",
        curves: Curves::fixed([0.35, 0.6, 0.7], [0.15, 0.2, 0.25, 0.3, 0.35], [0.3, 0.5, 0.65, 0.85, 0.9]),
        height: 1.0,
        width: 0.0025,
        spread: 0.06,
        bending: 0.7,
        splay: 0.4,
        stiffness: 0.7,
        taper: 0.8,
        fold: 0.5,
        variation: 0.4,
        heads: 2,
        stalk: 1.35,
        head_length: 0.5,
        head_width: 0.02,
        good: [0.196, 0.274, 0.073],
        bad: [0.477, 0.393, 0.179],
        head: [0.58, 0.53, 0.4],
    },
    // The tall grass of hay meadows, lush on deep soil, with a loose golden panicle.
    Species {
        name: "oat-grass",
        curves: Curves::fixed([0.05, 0.5, 1.0], [0.15, 0.3, 0.5, 0.7, 0.8], [0.5, 0.8, 0.95, 0.9, 0.6]),
        height: 1.3,
        width: 0.009,
        spread: 0.06,
        bending: 0.8,
        splay: 0.5,
        stiffness: 1.1,
        taper: 1.0,
        fold: 0.3,
        variation: 0.4,
        heads: 1,
        stalk: 1.6,
        head_length: 0.22,
        head_width: 0.015,
        good: [0.064, 0.205, 0.03],
        bad: [0.393, 0.319, 0.084],
        head: [0.507, 0.342, 0.107],
    },
];

impl Species {
    /// The built-in species of that name.
    pub fn named(name: &str) -> Option<&'static Self> {
        SPECIES.iter().find(|species| species.name == name)
    }

    /// The greatest height of a blade or stalk in metres.
    pub fn top(&self) -> f32 {
        self.height * self.stalk.max(1.0)
    }

    /// The colour of a blade in linear light, by its share of the good colour and that of the head.
    pub fn colour(&self, blend: f32, head: f32) -> [f32; 3] {
        std::array::from_fn(|i| {
            let leaf = blend * self.good[i] + (1.0 - blend) * self.bad[i];
            head * self.head[i] + (1.0 - head) * leaf
        })
    }
}
