//! Plants in the wind: each part of a plant turns about its joint, in its own time.
//!
//! The code of a point is an address: its digits say from which branch of which branch it hangs. Every digit that is no
//! [stem](Role::Stem) is a part with a joint, and turns by a small angle there (the part-wise maps of Han and Kim 2007,
//! eq. 17 to 20, at every depth at once). What a part turns by depends on its **order**, the number of branchings on the
//! way to it: the trunk leans slowly and far, leaflets flutter quickly and little. Along an axis the turn is shared out by
//! its digits in a geometric series, as a rod bends most where it is thick and held.
//!
//! With `u` the direction of a part, `w` that of the wind and `p = w × up`, the part turns about
//! `share · (lean · (u × w) + swing(t) · p)`: it leans out of the wind as far as it stands across it, and swings in the
//! plane of the wind. [`Sway`] puts this onto points; its shader is `sway.wgsl`.
//!
//! A joint is carried by the part from which it hangs and is the fixed point of the turn of what hangs there: branches
//! stay attached. Without wind every turn is nothing and every point keeps its bits.

mod device;
mod row;
mod sway;
#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

pub use device::{Plant, SWAY};
pub use row::Posed;
pub(super) use sway::{AT_JOINT, cross, dot, rotated, subtract};
pub use sway::{Sway, WORDS};

use super::system::Role;
use weald_core::parameters;
use weald_core::random::{hash2, unit};

/// Orders of branching that differ; further ones move as the last.
pub const ORDERS: usize = 4;

/// Phases that parts of an order can have.
pub const PHASES: usize = 64;

parameters! {
    /// The wind.
    pub struct Wind {
        /// Speed of the wind; 4 moves leaves, 10 sways the plant, 25 bends it down.
        speed: f64 = 4.0, range 0.0..=60.0, unit "m/s";
        /// Where it blows to: 0 along x, 90 along z, which for a 2D plant is towards the camera or away from it.
        direction_deg: f64 = 0.0, range -360.0..=360.0, unit "deg";
        /// How much its speed varies: 0 is steady, 1 comes in squalls.
        gusts: f64 = 0.5, range 0.0..=1.0;
        /// Time after which the motion begins again; without it the motion never repeats.
        seconds: Option<f64> = None, range 0.1..=3600.0, unit "s";
        /// How stiff the plant is: divides the bending angles.
        stiffness: f64 = 1.0, range 0.05..=20.0;
        /// Another seed is another course of gusts.
        seed: u64 = 1, range 0..=9_007_199_254_740_991_u64;
    }
}

/// How an order of parts moves.
pub(super) struct Order {
    /// Turn out of a gale that the parts stand across.
    pub(super) lean: f64,
    /// Greatest turn of its swing in a gale.
    pub(super) swing: f64,
    /// Swings a second.
    pub(super) frequency: f64,
}

/// Trunk, fronds, leaflets and what is smaller.
pub(super) const MOTION: [Order; ORDERS] = [
    Order { lean: 1.1, swing: 0.16, frequency: 0.45 },
    Order { lean: 0.45, swing: 0.22, frequency: 1.0 },
    Order { lean: 0.25, swing: 0.22, frequency: 2.1 },
    Order { lean: 0.1, swing: 0.16, frequency: 3.4 },
];

/// Shares of the gust that come and go with these periods in seconds; in a loop they become whole parts of it.
const GUSTS: [(f64, f64); 3] = [(0.5, 7.3), (0.3, 3.1), (0.2, 1.7)];

/// Speed at which half of the greatest lean is reached.
const HALF_LEAN: f64 = 12.0;

/// Speed at which half of the greatest swing is reached.
const HALF_SWING: f64 = 6.0;

/// What the wind does at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// Direction of the wind, of length 1.
    pub wind: [f32; 3],
    /// `w × up`, about which parts swing.
    pub across: [f32; 3],
    /// Lean of each order.
    pub lean: [f32; ORDERS],
    /// Swing of each order for each phase.
    pub swing: [[f32; PHASES]; ORDERS],
}

impl Wind {
    /// What it does at a time in seconds.
    pub fn pose(&self, seconds: f64) -> Pose {
        let angle = self.direction_deg.to_radians();
        let (x, z) = (libm::cos(angle), libm::sin(angle));
        let speed = self.speed_at(seconds);
        let gale = speed * speed / (speed * speed + HALF_LEAN * HALF_LEAN) / self.stiffness;
        let breeze = speed / (speed + HALF_SWING) / self.stiffness;
        Pose {
            wind: [x, 0.0, z].map(|x| x as f32),
            across: [-z, 0.0, x].map(|x| x as f32),
            lean: std::array::from_fn(|order| (MOTION[order].lean * gale) as f32),
            swing: std::array::from_fn(|order| {
                let motion = &MOTION[order];
                let cycles = self.cycles(seconds, 1.0 / motion.frequency);
                std::array::from_fn(|phase| {
                    let turns = cycles + phase as f64 / PHASES as f64;
                    (motion.swing * breeze * libm::sin(TAU * (turns - turns.floor()))) as f32
                })
            }),
        }
    }

    /// The moments of a film that begins again after its last frame; without `seconds` it has 24 frames per second.
    pub fn poses(&self, frames: u32) -> impl Iterator<Item = Pose> {
        let seconds = self.seconds.unwrap_or(f64::from(frames.max(1)) / 24.0);
        let looped = Self { seconds: Some(seconds), ..self.clone() };
        (0..frames).map(move |frame| looped.pose(seconds * (f64::from(frame) / f64::from(frames))))
    }

    /// Speed with its gusts, never below 0.
    fn speed_at(&self, seconds: f64) -> f64 {
        let gust: f64 = GUSTS
            .iter()
            .enumerate()
            .map(|(number, (share, period))| {
                let phase = unit(hash2(self.seed, number as i64, 0));
                let turns = self.cycles(seconds, *period) + phase;
                share * libm::sin(TAU * (turns - turns.floor()))
            })
            .sum();
        self.speed * (1.0 + self.gusts * gust).max(0.0)
    }

    /// How many periods have passed; where the motion is a loop, a whole number of them make it.
    fn cycles(&self, seconds: f64, period: f64) -> f64 {
        let Some(whole) = self.seconds else { return seconds / period };
        (whole / period).round().max(1.0) * (seconds / whole)
    }
}

impl Pose {
    /// Calm: nothing turns.
    pub fn calm() -> Self {
        Wind { speed: 0.0, ..Wind::default() }.pose(0.0)
    }

    /// Its numbers in the order of the shader's `Pose`: wind, across, lean, swing, in fours.
    pub fn numbers(&self) -> Vec<f32> {
        let four = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        [four(self.wind), four(self.across), self.lean]
            .concat()
            .into_iter()
            .chain(self.swing.concat())
            .collect()
    }
}
