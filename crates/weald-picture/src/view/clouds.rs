//! Fair-weather clouds: one layer of noise above the land, lit by the sun through itself, and the shadows that it throws.
//!
//! The layer is flat: a direction meets it in one place, and how dense it is there says how much of the sky it hides. What
//! lies towards the sun in it takes light from it. Clouds far away pale as the sky does. All numbers are chosen by eye.

use super::sky::Sky;
use super::vector::{Vector, add, dot, ramp, scale, subtract};
use crate::colour::mix;
use weald_core::grain::Octaves;

/// Metres from one cloud to the next, and of their base above the highest ground.
const APART: f32 = 2600.0;
const ABOVE: f32 = 1300.0;

/// Metres of cloud through which the sun's light comes to what is seen.
const THICK: f32 = 380.0;

/// Metres over which clouds are lost in the haze.
const LOST: f32 = 28_000.0;

/// Share of the sunlight that the densest cloud keeps off.
const SHADOW: f32 = 0.78;

/// Metres over which the edges of their shadows are soft.
const SOFT: f32 = 160.0;

/// A layer of clouds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clouds {
    /// Share of the sky that they hide.
    pub(super) share: f32,
    /// Height at which they lie, as it is drawn.
    pub(super) height: f32,
    /// Light of the sky on flat ground.
    pub(super) skylight: Vector,
}

impl Clouds {
    /// Clouds over ground that is so high, as it is drawn; `None` where they hide nothing.
    pub(super) fn new(share: f64, sky: &Sky, [highest, exaggeration]: [f32; 2]) -> Option<Self> {
        let skylight = subtract(sky.on_flat_ground(), scale(sky.sunlight, sky.sun[2]));
        let height = highest + ABOVE * exaggeration;
        (share > 0.0).then_some(Self { share: share as f32, height, skylight })
    }

    fn density(&self, [x, y]: [f32; 2], footprint: f32) -> f32 {
        let noise =
            Octaves { wavelength: APART, count: 7, gain: 0.56, seed: 0x71 }.at([x, y, 0.0], footprint);
        let least = 0.44 - 0.95 * self.share;
        ramp(noise.value, least, least + 0.34)
    }

    /// The radiance of the sky in a direction, with the clouds before it.
    pub(super) fn before(&self, sky: &Sky, [from, direction, radiance]: [Vector; 3]) -> Vector {
        if direction[2] < 0.01 || from[2] >= self.height {
            return radiance;
        }
        let length = (self.height - from[2]) / direction[2];
        let at = [0, 1].map(|axis| from[axis] + direction[axis] * length);
        let footprint = 0.002 * length;
        let density = self.density(at, footprint);
        let nearer = [0, 1].map(|axis| at[axis] + sky.sun[axis] / sky.sun[2].max(0.3) * THICK);
        let through = libm::expf(-2.4 * self.density(nearer, footprint) * density);
        let towards = dot(direction, sky.sun).max(0.0);
        let glow = 0.3 * (1.0 - density) * libm::powf(towards, 12.0);
        let lit = add(
            scale(sky.sunlight, 0.06 + 0.15 * through + glow),
            scale(self.skylight, (1.0 - 0.45 * density) * std::f32::consts::FRAC_1_PI),
        );
        mix(radiance, lit, density * libm::expf(-length / LOST))
    }

    /// Share of the sunlight that comes through them to a point.
    pub(super) fn through(&self, sky: &Sky, point: Vector) -> f32 {
        let length = (self.height - point[2]).max(0.0) / sky.sun[2].max(0.05);
        let at = [0, 1].map(|axis| point[axis] + sky.sun[axis] * length);
        1.0 - SHADOW * self.density(at, SOFT)
    }
}

#[cfg(test)]
mod tests {
    use super::super::vector::{towards, unit};
    use super::*;

    fn clouds(share: f64) -> (Sky, Option<Clouds>) {
        let sky = Sky::new(towards(200.0, 40.0), 0.53);
        let clouds = Clouds::new(share, &sky, [500.0, 1.0]);
        (sky, clouds)
    }

    /// Share of places of which the sun is hidden by more than a half.
    fn shaded(share: f64) -> f32 {
        let (sky, clouds) = clouds(share);
        let clouds = clouds.expect("some");
        let at = |place: usize| [150.0 * (place % 100) as f32, 170.0 * (place / 100) as f32, 0.0];
        (0..10_000).filter(|&place| clouds.through(&sky, at(place)) < 0.6).count() as f32 / 10_000.0
    }

    #[test]
    fn more_clouds_shade_more_of_the_land_and_none_none() {
        assert!(clouds(0.0).1.is_none());
        let shares = [0.2, 0.5, 0.9].map(shaded);
        assert!(shares[0] < 0.25 && shares[2] > 0.6 && shares.is_sorted(), "{shares:?}");
    }

    #[test]
    fn shadows_lie_where_the_clouds_are_that_the_sun_shines_through() {
        let (sky, clouds) = clouds(0.5);
        let clouds = clouds.expect("some");
        for place in 0..200 {
            let point = [400.0 * place as f32, 90.0 * place as f32, 0.0];
            let seen = clouds.before(&sky, [point, sky.sun, [0.0; 3]]);
            let dark = clouds.through(&sky, point) < 0.3;
            assert!(!dark || seen[1] > 0.0, "at {point:?} nothing hides the sun");
        }
    }

    #[test]
    fn below_the_horizon_and_above_the_clouds_there_are_none() {
        let (sky, clouds) = clouds(1.0);
        let clouds = clouds.expect("some");
        let radiance = [0.1, 0.2, 0.3];
        for (from, direction) in [([0.0; 3], [1.0, 0.0, -0.1]), ([0.0, 0.0, 9000.0], [0.0, 0.6, 0.8])] {
            assert_eq!(clouds.before(&sky, [from, unit(direction), radiance]), radiance);
        }
    }
}
