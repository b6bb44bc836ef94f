//! From light to bytes: exposure, a filmic curve, and dither.
//!
//! The curve is Stephen Hill's fit of the ACES reference and output transforms (2016): a soft toe, a long shoulder, and
//! bright colours that fade towards white as on film. Bytes are dithered with noise of a triangle's distribution, one
//! step wide, which is a function of the pixel: gradients of the sky show no bands, and the same picture comes out
//! each time.

use super::sky::Sky;
use super::vector::{Vector, luminance, ramp, scale, subtract};
use weald_core::random::{hash2, unit};

/// sRGB to the space of the curve, and back.
pub(super) const INTO: [Vector; 3] =
    [[0.597_19, 0.354_58, 0.048_23], [0.076, 0.908_34, 0.015_66], [0.028_4, 0.133_83, 0.837_77]];
pub(super) const BACK: [Vector; 3] =
    [[1.604_75, -0.531_08, -0.073_67], [-0.102_08, 1.108_13, -0.006_05], [-0.003_27, -0.072_76, 1.076_02]];

/// The curve `(v (v + a) + b) / (v (c v + d) + e)`.
pub(super) const CURVE: [f32; 5] = [0.024_578_6, -0.000_090_537, 0.983_729, 0.432_951, 0.238_081];

/// Radiance, before the curve, of a white surface in full light.
const WHITE: f32 = 1.5;

/// How far the picture's white follows the colour of the light on flat ground, 0 to 1: under a low sun, whose light is to
/// look warm, and under one from a sine of its altitude on.
const ADAPTATION: [f32; 2] = [0.4, 0.75];
const HIGH_SUN: f32 = 0.3;

/// Light of the sky on flat ground counts so much at least, as a multiple: under a low sun the sky is far brighter than
/// the ground, and would be white.
const OF_SKY: f32 = 3.2;

/// The most, in surfaces that are drawn as white, that one ray counts.
pub(super) const BRIGHTEST: f32 = 12.0;

/// A camera's exposure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tone {
    gain: Vector,
}

impl Tone {
    /// The exposure for the light on flat ground under that sky, brighter by so many stops.
    pub(super) fn new(sky: &Sky, stops: f64) -> Self {
        let light = sky.on_flat_ground();
        let of_sky = subtract(light, scale(sky.sunlight, sky.sun[2]));
        let [low, high] = ADAPTATION;
        let adaptation = low + (high - low) * ramp(sky.sun[2], 0.0, HIGH_SUN);
        Self::of_light(light, OF_SKY * luminance(of_sky), adaptation, stops)
    }

    /// The exposure for light of that colour and of at least a brightness.
    fn of_light(light: Vector, least: f32, adaptation: f32, stops: f64) -> Self {
        let mean = luminance(light).max(1e-6);
        let exposure = WHITE * std::f32::consts::PI / mean.max(least) * libm::exp2(stops) as f32;
        Self { gain: light.map(|channel| exposure * libm::powf(mean / channel.max(1e-6), adaptation)) }
    }

    /// The bytes of a radiance at a pixel.
    pub(super) fn bytes(&self, radiance: Vector, [x, y]: [usize; 2]) -> [u8; 3] {
        let linear = self.curve(radiance);
        let bits = hash2(0x7019, x as i64, y as i64);
        let noise = unit(bits) + unit(bits.wrapping_mul(0x9e37_79b9_7f4a_7c15)) - 1.0;
        linear.map(|channel| {
            let encoded = if channel <= 0.003_130_8 {
                12.92 * channel
            } else {
                1.055 * libm::powf(channel, 1.0 / 2.4) - 0.055
            };
            (encoded * 255.0 + 0.5 + noise as f32).clamp(0.0, 255.0) as u8
        })
    }

    /// Factor on radiance before the curve.
    pub(super) fn gain(&self) -> Vector {
        self.gain
    }

    /// A radiance, but no more than some times what is drawn as white.
    pub(super) fn limited(&self, radiance: Vector) -> Vector {
        std::array::from_fn(|c| radiance[c].min(BRIGHTEST / self.gain[c]))
    }

    /// How bright a radiance looks on the screen, 0 to 1: about as bytes are encoded.
    pub(super) fn brightness(&self, radiance: Vector) -> f32 {
        luminance(self.curve(radiance)).max(0.0).sqrt()
    }

    /// Linear light on the screen, 0 to 1.
    fn curve(&self, radiance: Vector) -> Vector {
        let exposed = std::array::from_fn(|c| radiance[c].max(0.0) * self.gain[c]);
        let [a, b, c, d, e] = CURVE;
        let film = transform(&INTO, exposed).map(|v| (v * (v + a) + b) / (v * (c * v + d) + e));
        transform(&BACK, film).map(|channel| channel.clamp(0.0, 1.0))
    }
}

fn transform(rows: &[Vector; 3], colour: Vector) -> Vector {
    rows.map(|row| super::vector::dot(row, colour))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::vector::towards;

    #[test]
    fn a_low_sun_leaves_the_sky_its_colours_and_its_light_warm() {
        let at = |altitude_deg: f64| Sky::new(towards(200.0, altitude_deg), 0.53);
        let low = at(3.0);
        let facing_the_sun = |tone: Tone| tone.curve(scale(low.sunlight, 0.3 * std::f32::consts::FRAC_1_PI));
        let [warm, adapted] =
            [Tone::new(&low, 0.0), Tone::of_light(low.on_flat_ground(), 0.0, ADAPTATION[1], 0.0)]
                .map(facing_the_sun);
        assert!(warm[0] / warm[2] > 1.15 * adapted[0] / adapted[2], "{warm:?} and {adapted:?}");
        // Away from the sun, half-way up.
        let aside = towards(20.0, 45.0);
        let [red, _, blue] = Tone::new(&at(3.0), 0.0).curve(at(3.0).radiance(aside));
        assert!(blue < 0.9 && blue > red + 0.02, "the sky is {red} and {blue}");
    }

    #[test]
    fn brighter_light_gives_brighter_bytes_and_never_more_than_white() {
        let tone = Tone::of_light([3.0, 2.8, 2.5], 0.0, 0.75, 0.0);
        let grey = |light: f32| tone.curve([light; 3])[1];
        let ramp: Vec<f32> = (0..200).map(|i| grey(i as f32 * 0.02)).collect();
        assert!(ramp.windows(2).all(|pair| pair[1] >= pair[0]));
        assert!(ramp[0] == 0.0 && ramp[199] > 0.9);
        assert_eq!(tone.bytes([1e6; 3], [3, 4]), [255; 3]);
    }

    #[test]
    fn dither_keeps_the_mean_of_a_gradient_finer_than_a_byte() {
        let tone = Tone::of_light([3.0; 3], 0.0, 0.75, 0.0);
        let mean = |light: f32| {
            (0..4096).map(|p| f64::from(tone.bytes([light; 3], [p % 64, p / 64])[1])).sum::<f64>() / 4096.0
        };
        let means: Vec<f64> = (0..10).map(|i| mean(0.3 + 0.0005 * i as f32)).collect();
        assert!(means.windows(2).all(|pair| pair[1] > pair[0]), "{means:?}");
        assert!(means[9] - means[0] < 3.0);
    }
}
