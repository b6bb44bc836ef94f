//! The wind over the land as all that stands on it feels it: gusts that travel, by which neighbours sway nearly as one.
//!
//! The push at a place is octaves of noise that move with the wind, and a flutter of each plant's own. Its length is the
//! tangent by which an upright tip leans out of it. `wind.wgsl` is its twin, after the functions of `grain`,
//! which is what blades and leaves are given on a device ([`FUNCTIONS`]).

use weald_core::grain::Octaves;

/// Direction in which the wind blows, and its gusts travel: east and north, of length 1.
pub const TOWARDS: [f32; 2] = [0.92, 0.391_918_36];

/// Speed of the gusts in metres per second.
pub const SPEED: f32 = 3.5;

/// Push without gusts, and how much these add at most.
pub const STEADY: f32 = 0.16;
const GUSTS: f32 = 0.28;

/// Gusts from 14 m downward.
const OCTAVES: Octaves = Octaves { wavelength: 14.0, count: 3, gain: 0.6, seed: 0x61 };

/// Push of the flutter, and its turns a second.
const FLUTTER: f32 = 0.05;
const FREQUENCY: f32 = 1.7;

/// In WGSL, [`push`] and [`wave`]: to be put behind the functions of light of a picture's scene, which has
/// the noise.
pub const FUNCTIONS: &str = include_str!("wind.wgsl");

/// The push east and north at a place in metres east and north, a moment in seconds, and a phase from 0 to 1.
pub fn push([east, north]: [f32; 2], seconds: f32, phase: f32) -> [f32; 2] {
    let drift = seconds * SPEED;
    let gust = OCTAVES.at([east - drift * TOWARDS[0], north - drift * TOWARDS[1], 0.0], 0.0).value;
    let strength = STEADY + GUSTS * gust + FLUTTER * wave(FREQUENCY * seconds + phase);
    TOWARDS.map(|part| strength.max(0.0) * part)
}

/// A wave like a sine, of parabolas, by the turns since it began: 0, 1 after a quarter, 0, -1.
pub fn wave(turns: f32) -> f32 {
    let along = 2.0 * (turns - turns.floor());
    let t = if along > 1.0 { along - 2.0 } else { along };
    4.0 * t * (1.0 - t.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_travel_with_the_wind_and_neighbours_feel_nearly_the_same() {
        let length = |[east, north]: [f32; 2]| east.hypot(north);
        let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
        for step in 0..400_u16 {
            let place = [f32::from(step) * 3.1, f32::from(step) * -1.7];
            let here = length(push(place, 0.0, 0.0));
            let there = place.map(|at| at + 0.2);
            assert!((length(push(there, 0.0, 0.0)) - here).abs() < 0.04, "{place:?}");
            // A whole number of flutters later the gust has gone so far.
            let later = 10.0 / FREQUENCY;
            let carried = [0, 1].map(|axis| place[axis] + later * SPEED * TOWARDS[axis]);
            assert!((length(push(carried, later, 0.0)) - here).abs() < 2e-3, "{place:?}");
            (least, most) = (least.min(here), most.max(here));
        }
        assert!(least < 0.08 && most > 0.25 && most < 0.5, "{least} to {most}");
    }

    #[test]
    fn a_wave_is_within_six_hundredths_of_a_sine() {
        for turn in 0..1000_u16 {
            let turns = 0.013 * f32::from(turn);
            assert!((wave(turns) - (std::f32::consts::TAU * turns).sin()).abs() < 0.06, "{turns}");
        }
    }
}
