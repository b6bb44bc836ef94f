//! Short grass as it looks from so near that its tufts are seen: light tips, dark gaps, and withered blades between them.
//!
//! Lengths are those of grass and hang on no cell. All numbers are chosen by eye.

use super::slope_grain::on_slope;
use super::vector::{Vector, ramp};
use crate::colour::{Linear, mix};
use weald_core::grain::Octaves;

/// Metres from one tuft to the next, the number of octaves down to blades, and what each is against the one before.
const TUFTS: f32 = 0.24;
const OCTAVES: u32 = 6;
const GAIN: f32 = 0.95;
const SEED: u32 = 0x15;

/// What tips and gaps add to the light that comes back, and bounds of it.
const SHADE: f32 = 0.7;
const LIGHT: [f32; 2] = [0.4, 1.7];

/// Noise between which blades are withered, and their greatest share.
const WITHERED: [f32; 2] = [0.2, 0.8];
const MOST_WITHERED: f32 = 0.55;

/// Height of the noise in metres.
const HIGH: f32 = 0.008;

/// Turf at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turf {
    /// Its colour.
    pub(super) albedo: Linear,
    /// Slope of its tufts, eastward and northward.
    pub(super) slope: [f32; 2],
}

/// Turf of a mean colour, and one of withered grass, on ground that rises so eastward and northward, for a pixel of that footprint
/// in metres.
pub(super) fn turf(point: Vector, rise: [f32; 2], footprint: f32, [mean, withered]: [Linear; 2]) -> Turf {
    let octaves = Octaves { wavelength: TUFTS, count: OCTAVES, gain: GAIN, seed: SEED };
    let noise = on_slope(octaves, point, rise, footprint);
    let light = (1.0 + SHADE * noise.value).clamp(LIGHT[0], LIGHT[1]);
    let share = MOST_WITHERED * ramp(noise.value, WITHERED[0], WITHERED[1]);
    let albedo = mix(mean, withered, share).map(|channel| light * channel);
    Turf { albedo, slope: noise.slope.map(|rise| HIGH * rise) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEAN: Linear = [0.1, 0.2, 0.05];
    const WITHERED_GRASS: Linear = [0.25, 0.2, 0.1];

    fn brightness(footprint: f32) -> [f32; 2] {
        let at = |step: u16| {
            let point = [0.173 * f32::from(step), 0.091 * f32::from(step), 0.0];
            turf(point, [0.0; 2], footprint, [MEAN, WITHERED_GRASS]).albedo[1] / MEAN[1]
        };
        let mean = (0..4000).map(at).sum::<f32>() / 4000.0;
        [mean, ((0..4000).map(|step| (at(step) - mean).powi(2)).sum::<f32>() / 4000.0).sqrt()]
    }

    #[test]
    fn tufts_are_seen_from_close_by_and_are_even_from_afar() {
        let [near, far] = [0.002, 0.4].map(brightness);
        assert!((0.93..1.07).contains(&near[0]), "as bright as from afar on the average: {near:?}");
        assert!((0.2..0.4).contains(&near[1]), "tips and gaps: {near:?}");
        assert!((far[0] - 1.0).abs() < 1e-6 && far[1] < 1e-6, "{far:?}");
    }
}
