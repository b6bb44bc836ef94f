//! Noise for what is smaller than a cell: patches of plants, cracks of rock, ripples.
//!
//! Gradient noise after Perlin 2002, doi 10.1145/566654.566636, with hashed directions, and its exact slope. It is a
//! function of the place alone. Octaves finer than the footprint of a pixel fade out before they could flicker.

use crate::vectors;

/// The twin of this noise for shaders.
pub const SHADER: &str = include_str!("grain.wgsl");

/// Noise and its slope along both axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grain {
    /// About -0.7 to 0.7.
    pub value: f32,
    /// Change by one wavelength.
    pub slope: [f32; 2],
}

/// Bits of a lattice point: the finaliser `lowbias32` (C. Wellons 2018).
#[inline(always)]
pub fn bits(x: i32, y: i32, seed: u32) -> u32 {
    let mut h =
        (x as u32).wrapping_mul(0xc13f_a9a9).wrapping_add((y as u32).wrapping_mul(0x91e1_0da5)) ^ seed;
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

/// The gradient of a lattice point: one of a circle's directions, by the parabola in place of the sine.
#[inline(always)]
fn gradient(x: i32, y: i32, seed: u32) -> [f32; 2] {
    let turn = (bits(x, y, seed) as i32 >> 8) as f32 * (1.0 / 8_388_608.0);
    let quarter = if turn < -0.5 { turn + 1.5 } else { turn + 0.5 };
    let wave = |t: f32| {
        let t = if t > 1.0 { t - 2.0 } else { t };
        4.0 * t * (1.0 - t.abs())
    };
    [wave(quarter), wave(turn)]
}

/// The whole number at or below one of less than 2³¹: `f32::floor` is a call where the machine is not known.
#[inline(always)]
pub fn floor(number: f32) -> i32 {
    let whole = number as i32;
    whole - i32::from(whole as f32 > number)
}

/// Noise at a place that is counted in wavelengths.
#[inline(always)]
pub fn grain(place: [f32; 2], seed: u32) -> Grain {
    let [x, y] = place.map(floor);
    let corner = [x, y].map(|c| c as f32);
    let (u, v) = (place[0] - corner[0], place[1] - corner[1]);
    let ease = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let ease_slope = |t: f32| 30.0 * t * t * (t * (t - 2.0) + 1.0);
    let g = [
        gradient(x, y, seed),
        gradient(x + 1, y, seed),
        gradient(x, y + 1, seed),
        gradient(x + 1, y + 1, seed),
    ];
    let plane = |g: [f32; 2], u: f32, v: f32| g[0] * u + g[1] * v;
    let [a, b] = [plane(g[0], u, v), plane(g[1], u - 1.0, v)];
    let [c, d] = [plane(g[2], u, v - 1.0), plane(g[3], u - 1.0, v - 1.0)];
    let (across, down) = (ease(u), ease(v));
    let twist = a - b - c + d;
    let blend = |k: usize| {
        g[0][k]
            + across * (g[1][k] - g[0][k])
            + down * (g[2][k] - g[0][k])
            + across * down * (g[0][k] - g[1][k] - g[2][k] + g[3][k])
    };
    Grain {
        value: a + across * (b - a) + down * (c - a) + across * down * twist,
        slope: [
            blend(0) + ease_slope(u) * (b - a + down * twist),
            blend(1) + ease_slope(v) * (c - a + across * twist),
        ],
    }
}

/// How much of an octave a pixel of that footprint still shows: all below a quarter of the wavelength, nothing above
/// seven tenths.
#[inline(always)]
pub fn visible(footprint: f32, wavelength: f32) -> f32 {
    let share = ((0.7 - footprint / wavelength) * (1.0 / 0.45)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Octaves of noise from `wavelength` downward, each half as long and `gain` times as strong.
#[derive(Clone, Copy, Debug)]
pub struct Octaves {
    /// Longest wavelength in metres.
    pub wavelength: f32,
    /// Number of octaves.
    pub count: u32,
    /// Strength of each against the one before.
    pub gain: f32,
    /// What makes this noise another than that of other seeds.
    pub seed: u32,
}

impl Octaves {
    /// The values of the sum at many points, for pixels of one footprint in metres, as [`Octaves::at`] has them; the points,
    /// eastward and northward, are used up.
    pub fn values(&self, [east, north]: [&mut [f32]; 2], footprint: f32) -> Vec<f32> {
        let mut sums = vec![0.0; east.len()];
        let (mut strength, mut wavelength) = (1.0, self.wavelength);
        for octave in 0..self.count {
            let seen = strength * visible(footprint, wavelength);
            if seen <= 0.0 {
                break;
            }
            let seed = self.seed.wrapping_add(octave.wrapping_mul(0x9e37_79b9));
            vectors::widest(
                #[inline(always)]
                || {
                    for ((sum, x), y) in sums.iter_mut().zip(&mut *east).zip(&mut *north) {
                        *sum += seen * grain([*x / wavelength, *y / wavelength], seed).value;
                        [*x, *y] = [0.8 * *x + 0.6 * *y, 0.8 * *y - 0.6 * *x];
                    }
                },
            );
            strength *= self.gain;
            wavelength *= 0.5;
        }
        sums
    }

    /// The sum at a point, for a pixel of that footprint in metres; the slope is a metre.
    pub fn at(&self, point: [f32; 3], footprint: f32) -> Grain {
        let (mut sum, mut strength, mut wavelength) = (Grain::default(), 1.0, self.wavelength);
        // Each octave is turned by the angle of the 3-4-5 triangle, so that lattices do not align.
        let mut place = [point[0], point[1]];
        let mut turn = [1.0_f32, 0.0];
        for octave in 0..self.count {
            let seen = strength * visible(footprint, wavelength);
            if seen <= 0.0 {
                break;
            }
            let here = grain(
                place.map(|metres| metres / wavelength),
                self.seed.wrapping_add(octave.wrapping_mul(0x9e37_79b9)),
            );
            sum.value += seen * here.value;
            let [a, b] = here.slope.map(|slope| seen * slope / wavelength);
            sum.slope[0] += turn[0] * a - turn[1] * b;
            sum.slope[1] += turn[1] * a + turn[0] * b;
            place = [0.8 * place[0] + 0.6 * place[1], 0.8 * place[1] - 0.6 * place[0]];
            turn = [0.8 * turn[0] - 0.6 * turn[1], 0.8 * turn[1] + 0.6 * turn[0]];
            strength *= self.gain;
            wavelength *= 0.5;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_points_have_the_bits_of_each() {
        let octaves = Octaves { wavelength: 40.0, count: 6, gain: 0.55, seed: 7 };
        let points: Vec<[f32; 2]> = (0..77).map(|i| [i as f32 * 3.7 - 90.0, i as f32 * -1.9]).collect();
        for footprint in [0.0, 3.0, 12.0, 100.0] {
            let mut axes = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<_>>());
            let [east, north] = &mut axes;
            let values = octaves.values([east, north], footprint);
            for (value, [x, y]) in values.into_iter().zip(&points) {
                assert_eq!(value, octaves.at([*x, *y, 0.0], footprint).value);
            }
        }
    }

    #[test]
    fn the_slope_is_that_of_the_value() {
        let octaves = Octaves { wavelength: 40.0, count: 4, gain: 0.5, seed: 7 };
        let mut steepest = 0.0_f32;
        for i in 0..200 {
            let point = [i as f32 * 3.7, i as f32 * -1.9, 0.0];
            let at = |dx: f32, dy: f32| octaves.at([point[0] + dx, point[1] + dy, 0.0], 0.0);
            let here = at(0.0, 0.0);
            let measured =
                [at(0.05, 0.0).value - at(-0.05, 0.0).value, at(0.0, 0.05).value - at(0.0, -0.05).value];
            for (slope, rise) in here.slope.iter().zip(measured) {
                assert!((slope - rise / 0.1).abs() < 5e-3, "{slope} for {}", rise / 0.1);
                steepest = steepest.max(slope.abs());
            }
        }
        assert!(steepest > 0.02);
    }

    #[test]
    fn octaves_below_the_footprint_are_gone() {
        let octaves = Octaves { wavelength: 8.0, count: 3, gain: 0.5, seed: 1 };
        assert_eq!(octaves.at([3.0, 4.0, 0.0], 8.0), Grain::default());
        assert_ne!(octaves.at([3.0, 4.0, 0.0], 0.1), Grain::default());
    }
}
