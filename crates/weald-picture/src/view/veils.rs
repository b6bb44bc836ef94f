//! Veils of ice high above heaps of cloud: streaks of noise that the wind draws out and that bend across it, thin enough for the
//! sky to be seen through them.

use super::clouds::Clouds;
use super::sky::Sky;
use super::vector::{Vector, add, ramp, scale};
use crate::colour::mix;
use weald_core::grain::Octaves;

/// Veils of ice high above: metres above the base of heaps, from one streak to the next, and how many times as long they are; the
/// octaves of their noise and what each is against the one before; between which noise they lie, how much they hide at most,
/// and what share of the sunlight they send to the eye; metres over which they are lost in the haze. The wind draws them out
/// along a direction, and across it they are bent by noise.
const VEILS_ABOVE: f32 = 6000.0;
const VEILS: f32 = 3200.0;
const VEILS_LONG: f32 = 6.0;
const VEIL_OCTAVES: (u32, f32) = (7, 0.68);
const VEILED: [f32; 2] = [0.02, 0.75];
const VEILS_HIDE: f32 = 0.26;
const VEILS_SEND: f32 = 0.2;
const VEILS_LOST: f32 = 60_000.0;
const VEIL_WIND: [f32; 2] = [0.8, 0.6];
const VEILS_BENT: f32 = 0.4;

impl Clouds {
    /// The radiance of the sky in a direction above the horizon, with veils of ice before it.
    pub(super) fn veiled(&self, sky: &Sky, [from, direction, radiance]: [Vector; 3], blur: f32) -> Vector {
        let reach = (self.height + VEILS_ABOVE - from[2]) / direction[2];
        let [x, y, _] = add(from, scale(direction, reach));
        let [east, north] = VEIL_WIND;
        let (along, across) = ((east * x + north * y) / VEILS_LONG, north * x - east * y);
        let footprint = blur * reach / direction[2];
        let bent = Octaves { wavelength: 4.0 * VEILS, count: 2, gain: 0.5, seed: 0x73 };
        let across = across + VEILS_BENT * VEILS * bent.at([along, across, 0.0], footprint).value;
        let (count, gain) = VEIL_OCTAVES;
        let noise = Octaves { wavelength: VEILS, count, gain, seed: 0x74 };
        let here = ramp(noise.at([along, across, 0.0], footprint).value, VEILED[0], VEILED[1]);
        let light = add(scale(sky.sunlight, VEILS_SEND), scale(self.skylight, std::f32::consts::FRAC_1_PI));
        mix(radiance, light, VEILS_HIDE * here * libm::expf(-reach / VEILS_LOST))
    }
}

#[cfg(test)]
mod tests {
    use super::super::vector::{towards, unit};
    use super::*;

    #[test]
    fn veils_hide_a_little_here_and_there_and_nothing_above_the_horizon() {
        let sky = Sky::new(towards(200.0, 40.0), 0.53);
        let clouds = Clouds::new(0.3, &sky, [500.0, 1.0]).expect("some");
        let sky = Sky { sunlight: [0.0; 3], ..sky };
        let hidden = |direction: Vector, blur: f32| {
            let blue = [0.0, 0.0, 1.0];
            let veiled = clouds.veiled(&sky, [[0.0; 3], direction, blue], blur)[2];
            (1.0 - veiled) / (1.0 - clouds.skylight[2] * std::f32::consts::FRAC_1_PI)
        };
        let overhead: Vec<f32> = (0..400)
            .map(|at| {
                hidden(unit([0.05 * (at % 20) as f32 - 0.5, 0.05 * (at / 20) as f32 - 0.5, 0.5]), 0.001)
            })
            .collect();
        let clear = overhead.iter().filter(|&&hidden| hidden < 0.01).count();
        let most = overhead.iter().copied().fold(0.0, f32::max);
        assert!((50..350).contains(&clear) && (0.05..=VEILS_HIDE).contains(&most), "{clear}, {most}");
        assert!((0..60).all(|turn| hidden(unit(towards(6.0 * f64::from(turn), 0.7)), 0.0) < 1e-3));
    }
}
