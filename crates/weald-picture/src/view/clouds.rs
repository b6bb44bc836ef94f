//! Fair-weather clouds: heaps of noise over one level above the land, lit by the sun, and the shadows that they throw.
//!
//! Noise says how far a place lies within a heap, less so further up, where heaps are narrower. A ray is looked at where it
//! meets levels one above the other, without what is finer than the way from one to the next; between the last without
//! cloud and the first with it lies the side of a heap. There all of the noise says how dense it is, and how much of it
//! lies towards the sun. Clouds far away pale as the sky does. All numbers are chosen by eye.

use super::sky::Sky;
use super::vector::{Vector, add, dot, ramp, scale, subtract};
use crate::colour::mix;
use weald_core::grain::{Grain, Octaves};

/// Metres from one cloud to the next, and of their base above the highest ground.
const APART: f32 = 2600.0;
const ABOVE: f32 = 1300.0;

/// Levels at which rays are looked at, and metres from one to the next.
const SLICES: usize = 16;
const SLICE: f32 = 32.0;

/// Noise by which the top of a heap is narrower than its base.
const NARROWER: f32 = 0.36;

/// Ways between two levels that are the least to be seen of a heap's form.
const COARSE: f32 = 1.8;

/// Noise over which the edge of a heap is soft, and how much softer it is for a radian that is seen as one.
const EDGE: f32 = 0.2;
const SOFTER: f32 = 5.0;

/// Noise below that of a heap from which a level counts as its side, so that a heap does not begin at a level all at once.
const SIDE: f32 = 0.12;

/// Metres of cloud through which the sun's light comes to what is seen.
const LIT: f32 = 420.0;

/// Metres over which clouds are lost in the haze.
const LOST: f32 = 28_000.0;

/// Share of the sunlight that the densest cloud keeps off.
const SHADOW: f32 = 0.78;

/// Metres over which the edges of their shadows are soft.
const SOFT: f32 = 160.0;

/// Where a ray meets a heap.
struct Met {
    /// The level, counted from the base.
    slice: f32,
    /// How far it is within there.
    within: f32,
    /// How much of it lies along the ray: squares of how far each level is within its side.
    passed: f32,
}

/// The place so many metres along a ray.
fn along(from: Vector, direction: Vector, reach: f32) -> [f32; 2] {
    [0, 1].map(|axis| from[axis] + direction[axis] * reach)
}

/// A layer of clouds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clouds {
    /// Share of the sky that they hide.
    pub(super) share: f32,
    /// Height at which they lie, as it is drawn.
    pub(super) height: f32,
    /// Light of the sky on flat ground.
    pub(super) skylight: Vector,
    /// Factor on heights.
    exaggeration: f32,
}

impl Clouds {
    /// Clouds over ground that is so high, as it is drawn; `None` where they hide nothing.
    pub(super) fn new(share: f64, sky: &Sky, [highest, exaggeration]: [f32; 2]) -> Option<Self> {
        let skylight = subtract(sky.on_flat_ground(), scale(sky.sunlight, sky.sun[2]));
        let height = highest + ABOVE * exaggeration;
        (share > 0.0).then_some(Self { share: share as f32, height, skylight, exaggeration })
    }

    /// How far a place is within a heap, as noise above what makes cloud there, at a share of its height.
    fn within(&self, [x, y]: [f32; 2], share: f32, footprint: f32) -> Grain {
        let noise =
            Octaves { wavelength: APART, count: 7, gain: 0.56, seed: 0x71 }.at([x, y, 0.0], footprint);
        let least = 0.44 - 0.95 * self.share + NARROWER * share * share;
        Grain { value: noise.value - least, ..noise }
    }

    /// Metres from one level to the next along a direction.
    fn spacing(&self, direction: Vector) -> f32 {
        SLICE * self.exaggeration / direction[2]
    }

    /// Where a ray meets a heap; `None` where it meets none.
    fn met(&self, from: Vector, direction: Vector) -> Option<Met> {
        let (spacing, first) = (self.spacing(direction), (self.height - from[2]) / direction[2]);
        let (mut met, mut before): (Option<Met>, f32) = (None, -1.0);
        for slice in 0..SLICES {
            let at = along(from, direction, first + slice as f32 * spacing);
            let here = self.within(at, slice as f32 / (SLICES - 1) as f32, COARSE * spacing);
            let side = here.value + SIDE;
            if met.is_none() && side > 0.0 {
                // The base is flat; a side lies between two levels.
                let (back, within) = match slice {
                    0 => (0.0, here.value),
                    _ => (side / (here.value - before), -SIDE),
                };
                met = Some(Met { slice: slice as f32 - back, within, passed: 0.0 });
            }
            if let Some(met) = &mut met {
                met.passed += side.max(0.0).powi(2);
            }
            before = here.value;
        }
        met
    }

    /// The radiance of the sky in a direction, with the clouds before it; `blur` is the angle in radians that is seen as one.
    pub(super) fn before(&self, sky: &Sky, [from, direction, radiance]: [Vector; 3], blur: f32) -> Vector {
        if direction[2] < 0.01 || from[2] >= self.height {
            return radiance;
        }
        let Some(met) = self.met(from, direction) else { return radiance };
        let share = met.slice / (SLICES - 1) as f32;
        let spacing = self.spacing(direction);
        let reach = (self.height - from[2]) / direction[2] + met.slice * spacing;
        let footprint = blur * reach / direction[2].sqrt();
        let at = along(from, direction, reach);
        let fine = self.within(at, share, footprint).value - met.within;
        let slope = self.within(at, share, COARSE * spacing).slope;
        let density = ramp(met.passed.sqrt() - SIDE + 0.4 * fine, 0.0, EDGE + SOFTER * blur);
        let sunward = [0, 1].map(|axis| LIT * sky.sun[axis] / sky.sun[2].max(0.3));
        let uphill = slope[0] * sunward[0] + slope[1] * sunward[1];
        let through = libm::expf(-3.4 * (met.within + 0.3 + uphill - 0.7 * fine - 0.25 * share).max(0.0));
        let glow = 0.3 * (1.0 - density) * libm::powf(dot(direction, sky.sun).max(0.0), 12.0);
        let lit = add(
            scale(sky.sunlight, 0.03 + 0.24 * through + glow),
            scale(self.skylight, (0.45 + 0.5 * share) * std::f32::consts::FRAC_1_PI),
        );
        mix(radiance, lit, density * libm::expf(-reach / LOST))
    }

    /// Share of the sunlight that comes through them to a point.
    pub(super) fn through(&self, sky: &Sky, point: Vector) -> f32 {
        let length = (self.height - point[2]).max(0.0) / sky.sun[2].max(0.05);
        let at = [0, 1].map(|axis| point[axis] + sky.sun[axis] * length);
        1.0 - SHADOW * ramp(self.within(at, 0.0, SOFT).value, 0.0, 0.34)
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
            let seen = clouds.before(&sky, [point, sky.sun, [0.0; 3]], 0.001);
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
            assert_eq!(clouds.before(&sky, [from, unit(direction), radiance], 0.001), radiance);
        }
    }
}
