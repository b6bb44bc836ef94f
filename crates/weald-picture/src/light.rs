//! Light on a slope: a sun, two weaker lights beside it, and the sky above.
//!
//! Lambert's law `max(0, n·l)` for each light, in the manner of Mark 1992, "Multidirectional, oblique-weighted,
//! shaded-relief image of the Island of Hawaii" (USGS OFR 92-422): lights beside the sun give form to slopes
//! that run along its rays. Differs: weights are fixed, lit slopes turn warm and shaded ones bluish, and flat
//! ground comes out exactly as its tint, so that a picture keeps the colours of its ramp.

use super::colour::Linear;

/// Angle between the sun and each side light.
const SIDE_DEG: f64 = 58.0;

/// Shares of the sun, of each side light and of the sky in the light on flat ground.
const SUN_SHARE: f32 = 0.60;
const SIDE_SHARE: f32 = 0.13;
const SKY_SHARE: f32 = 1.0 - SUN_SHARE - 2.0 * SIDE_SHARE;

/// Colour of the sun against that of the sky, both relative to white.
const SUN_COLOUR: Linear = [1.07, 1.0, 0.89];
const SKY_COLOUR: Linear = [0.78, 0.95, 1.24];

/// Softness of the line where a slope turns away from a light, in units of `n·l`.
const TERMINATOR: f32 = 0.10;

/// Lights, ready to fall on slopes.
#[derive(Clone, Debug)]
pub(super) struct Lights {
    rays: [[f32; 3]; 3],
    level: Linear,
}

impl Lights {
    /// Lights from a sun at that azimuth (from north over east) and altitude.
    pub(super) fn new(azimuth_deg: f64, altitude_deg: f64) -> Self {
        let ray = |turn: f64| {
            let (azimuth, altitude) = ((azimuth_deg + turn).to_radians(), altitude_deg.to_radians());
            let across = libm::cos(altitude);
            [across * libm::sin(azimuth), -across * libm::cos(azimuth), libm::sin(altitude)].map(|c| c as f32)
        };
        let mut lights = Self { rays: [ray(0.0), ray(-SIDE_DEG), ray(SIDE_DEG)], level: [1.0; 3] };
        lights.level = lights.raw(0.0, 0.0);
        lights
    }

    /// Light on a slope that rises by `east` and `south`, relative to flat ground.
    #[inline]
    pub(super) fn on(&self, east: f32, south: f32) -> Linear {
        let raw = self.raw(east, south);
        std::array::from_fn(|c| raw[c] / self.level[c])
    }

    #[inline]
    fn raw(&self, east: f32, south: f32) -> Linear {
        let up = 1.0 / (east * east + south * south + 1.0).sqrt();
        let [sun, left, right] =
            self.rays.map(|ray| soft_positive((ray[2] - east * ray[0] - south * ray[1]) * up));
        let altitude = self.rays[0][2];
        let direct = (SUN_SHARE * sun + SIDE_SHARE * (left + right)) / altitude;
        let sky = SKY_SHARE * (0.5 + 0.5 * up);
        std::array::from_fn(|c| direct * SUN_COLOUR[c] + sky * SKY_COLOUR[c])
    }
}

fn soft_positive(cosine: f32) -> f32 {
    0.5 * (cosine + (cosine * cosine + TERMINATOR * TERMINATOR).sqrt())
}

/// Brightness above 1 bends towards `1 + room`, so that sunlit slopes never burn out.
#[inline]
pub(super) fn shoulder(brightness: f32, room: f32) -> f32 {
    let above = (brightness - 1.0).max(0.0);
    brightness.min(1.0) + room * above / (room + above)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_ground_keeps_its_colour_and_slopes_towards_the_sun_are_brighter_and_warmer() {
        let lights = Lights::new(315.0, 45.0);
        assert_eq!(lights.on(0.0, 0.0), [1.0; 3]);
        let (lit, shaded) = (lights.on(0.5, 0.5), lights.on(-0.5, -0.5));
        assert!(lit[1] > 1.1 && shaded[1] < 0.7, "{lit:?} {shaded:?}");
        assert!(lit[0] / lit[2] > shaded[0] / shaded[2]);
    }

    #[test]
    fn the_shoulder_rises_without_passing_its_room() {
        let bent: Vec<f32> = (0..100).map(|i| shoulder(i as f32 * 0.1, 0.3)).collect();
        assert!(bent.windows(2).all(|pair| pair[1] > pair[0]) && bent.iter().all(|&b| b < 1.3));
    }
}
