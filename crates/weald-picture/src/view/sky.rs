//! The sky as seen from the ground: radiance of any direction, the sun, and the light that falls from all of it.

use super::atmosphere::{Atmosphere, Scattered};
use super::vector::{Vector, add, dot, scale};

/// Pieces of the table over the elevation.
pub(super) const PIECES: usize = 96;

/// Sine of the elevation below which the sky is all alike: over ground that is drawn even, its brightest third of a degree
/// would be a bright line.
pub(super) const LOWEST: f32 = 0.006;

/// How strongly haze scatters forward: the glow around the sun.
const FORWARD: f32 = 0.76;

/// A sky.
#[derive(Clone, Debug)]
pub(super) struct Sky {
    /// Direction of the sun.
    pub(super) sun: Vector,
    /// Sunlight that falls on a surface that faces the sun; 1 outside the air.
    pub(super) sunlight: Vector,
    /// Half the angle that the sun's disc takes, in radians.
    pub(super) sun_radius: f32,
    /// By the square root of the sine of the elevation, which is finest at the horizon.
    pub(super) table: Vec<Scattered>,
}

impl Sky {
    /// The sky under a sun in that direction, whose disc takes `diameter_deg`.
    pub(super) fn new(sun: Vector, diameter_deg: f64) -> Self {
        let air = Atmosphere::new(f64::from(sun[2]));
        let elevation = |piece: usize| {
            let share = piece as f64 / PIECES as f64;
            air.scattered(share * share)
        };
        let sun_radius = (0.5 * diameter_deg).to_radians() as f32;
        Self { sun, sunlight: air.sunlight(), sun_radius, table: (0..=PIECES).map(elevation).collect() }
    }

    /// The sky as it lights the ground where clouds of a radiance hide a share of it.
    pub(super) fn behind_clouds(&self, share: f32, radiance: Vector) -> Self {
        let clear = 1.0 - share;
        let veiled = |piece: &Scattered| Scattered {
            rayleigh: scale(piece.rayleigh, clear),
            mie: scale(piece.mie, clear),
            multiple: add(scale(piece.multiple, clear), scale(radiance, share)),
        };
        Self { table: self.table.iter().map(veiled).collect(), ..self.clone() }
    }

    /// Radiance of a direction without the sun's disc; below the horizon that of the horizon.
    #[inline]
    pub(super) fn radiance(&self, direction: Vector) -> Vector {
        let place = direction[2].clamp(LOWEST, 1.0).sqrt() * PIECES as f32;
        let piece = (place as usize).min(PIECES - 1);
        let share = place - piece as f32;
        let (low, high) = (&self.table[piece], &self.table[piece + 1]);
        let mix = |low: Vector, high: Vector| add(scale(low, 1.0 - share), scale(high, share));
        let cosine = dot(direction, self.sun);
        let once = add(
            scale(mix(low.rayleigh, high.rayleigh), rayleigh_phase(cosine)),
            scale(mix(low.mie, high.mie), mie_phase(cosine)),
        );
        add(once, mix(low.multiple, high.multiple))
    }

    /// Radiance of a direction with the sun's disc, which darkens to its limb.
    pub(super) fn radiance_with_sun(&self, direction: Vector) -> Vector {
        let radiance = self.radiance(direction);
        let outside = (1.0 - dot(direction, self.sun)) / (1.0 - libm::cosf(self.sun_radius));
        if outside >= 1.0 || direction[2] <= 0.0 {
            return radiance;
        }
        let limb = 0.4 + 0.6 * (1.0 - outside).sqrt();
        let area = std::f32::consts::PI * self.sun_radius * self.sun_radius;
        add(radiance, scale(self.sunlight, limb / area))
    }

    /// Light on flat ground under the open sky.
    pub(super) fn on_flat_ground(&self) -> Vector {
        let mut sum = scale(self.sunlight, self.sun[2]);
        let patches = 16 * 32;
        for patch in 0..patches {
            let up = ((patch / 32) as f32 + 0.5) / 16.0;
            let around = std::f32::consts::TAU * ((patch % 32) as f32 + 0.5) / 32.0;
            let across = (1.0 - up * up).sqrt();
            let direction = [across * libm::sinf(around), across * libm::cosf(around), up];
            let share = std::f32::consts::TAU * up / patches as f32;
            sum = add(sum, scale(self.radiance(direction), share));
        }
        sum
    }
}

/// Share of light that molecules scatter by an angle of that cosine, a steradian.
#[inline(always)]
fn rayleigh_phase(cosine: f32) -> f32 {
    3.0 / (16.0 * std::f32::consts::PI) * (1.0 + cosine * cosine)
}

/// The same for haze: Cornette and Shanks 1992, doi 10.1364/AO.31.003152.
#[inline(always)]
fn mie_phase(cosine: f32) -> f32 {
    let g2 = FORWARD * FORWARD;
    let spread = (1.0 + g2 - 2.0 * FORWARD * cosine).max(1e-4);
    let factor = 3.0 / (8.0 * std::f32::consts::PI) * (1.0 - g2) / (2.0 + g2);
    factor * (1.0 + cosine * cosine) / (spread * spread.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::vector::unit;

    #[test]
    fn the_disc_of_the_sun_sends_the_sunlight_and_nothing_beside_it() {
        let sun = unit([0.3, 0.2, 0.6]);
        let sky = Sky::new(sun, 2.0);
        let disc = |direction: Vector| {
            let [with, without] = [sky.radiance_with_sun(direction), sky.radiance(direction)];
            (with[1] - without[1]) / sky.sunlight[1]
        };
        // Radiance times solid angle is light; the middle is the brightest of the disc.
        let area = std::f32::consts::PI * sky.sun_radius * sky.sun_radius;
        assert!((disc(sun) * area - 1.0).abs() < 0.01, "{}", disc(sun) * area);
        let east = sky.sun_radius;
        let limb = disc(unit([sun[0] + 0.8 * east, sun[1], sun[2]])) * area;
        assert!((0.4..1.0).contains(&limb), "{limb}");
        assert_eq!(disc(unit([sun[0] + 3.0 * east, sun[1], sun[2]])), 0.0);
    }
}
