//! How a blade grows: its width, height, bend and colour from the answers to soil and light, and the points of its stem.
//!
//! ```text
//! α = (f1 + f2) / 8      width, 0 to 1/4            β = (f1 + f3) / 2      height, 0 to 1
//! γ = β - α + f3         θ = π γ / 1.75 / 3         bend, 0 to π/3
//! b = (f1 + (f2 + f3) / 2) / 2                      how good the blade is, 0 to 1
//! P_0 = 0,  P_i = R(θ) (P_(i-1) + β^i up)           i = 1 to 4, R turning about the root
//! ```
//!
//! Kim and Cho 2009, eq. 1 and 5 to 7, with these differences. θ is said to lie within 0 to π/3, but γ goes from -0.125 to
//! 1.875 and θ with it from -4.29° to 64.29°; it is clamped. Eq. 7 prints the colour as `(1 - b) Good + b Bad`, which paints
//! the best grass bad; here b is the share of the good colour. As printed the whole stem turns by θ at each level, so that
//! for β = 1 the tip is below the root from 36° on; [`Bend::Total`], the default, turns by θ/4 and θ is the whole bend.
//! [`Bend::Printed`] keeps the source's. Spread is given to the root alone, not once more at each level.

use super::curves::Curves;
use super::random::{cosine, sine};
use weald_core::choices;

/// Levels of growth.
pub const LEVELS: usize = 4;

/// The greatest bend, π/3.
pub const MAX_BEND: f32 = std::f32::consts::FRAC_PI_3;

/// Radians of bend for each unit of γ: π / 1.75 / 3.
pub const BEND_OF_GAMMA: f32 = 0.598_398_6;

choices! {
    /// What θ means.
    pub enum Bend {
        /// The bend of the whole blade: each level turns by θ/4, and a tip is never below its root.
        Total = "total",
        /// The bend of each level, as printed.
        Printed = "printed",
    }
}

impl Bend {
    /// The share of θ by which a level turns.
    #[inline]
    pub fn of_a_level(self) -> f32 {
        match self {
            Self::Total => 0.25,
            Self::Printed => 1.0,
        }
    }
}

/// A point of a stem: upwards, and to where it bends. Its unit is the height of the first level at its best.
pub type Point = [f32; 2];

/// What soil and light make of a blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// α: the width, 0 to 1/4.
    pub width: f32,
    /// β: the height of the first level, 0 to 1. Each further level is β times as high.
    pub height: f32,
    /// θ: the bend in radians, 0 to π/3.
    pub bend: f32,
    /// b: the share of the good colour, 0 to 1.
    pub blend: f32,
}

impl Growth {
    /// The growth at a place of that soil and light, both 0 to 1.
    #[inline]
    pub fn at(curves: &Curves, soil: f32, light: f32) -> Self {
        Self::of(curves.soil.at(soil), curves.width.at(light), curves.height.at(light))
    }

    /// The growth of the three answers f1, f2 and f3, each 0 to 1.
    #[inline]
    pub fn of(soil: f32, wide: f32, tall: f32) -> Self {
        let width = (soil + wide) * 0.125;
        let height = (soil + tall) * 0.5;
        let gamma = height - width + tall;
        let blend = (soil + (wide + tall) * 0.5) * 0.5;
        Self { width, height, bend: (gamma * BEND_OF_GAMMA).clamp(0.0, MAX_BEND), blend }
    }

    /// The points of the stem: the root, and the tip of each level.
    #[inline]
    pub fn points(&self, bend: Bend) -> [Point; LEVELS + 1] {
        points(self.height, self.bend * bend.of_a_level())
    }
}

/// The points of a stem whose levels are so high and turn by that angle, 0 to π/3.
#[inline]
pub(super) fn points(height: f32, turn: f32) -> [Point; LEVELS + 1] {
    let (sine, cosine) = (sine(turn), cosine(turn));
    let mut points = [[0.0; 2]; LEVELS + 1];
    let mut power = 1.0;
    for level in 1..=LEVELS {
        let [up, out] = points[level - 1];
        power *= height;
        let grown = up + power;
        points[level] = [grown * cosine - out * sine, grown * sine + out * cosine];
    }
    points
}
