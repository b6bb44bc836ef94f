//! Aerial perspective: what lies far away pales into the colour of the horizon.
//!
//! ```text
//! L = L₀ T + L_h (1 - T)      T = e^(-β d)      β = 3.912 / visibility
//! ```
//!
//! Koschmieder 1924: at the distance `visibility` 2 % of the contrast are left. `L_h` is the radiance of the horizon
//! in that direction, which is brighter and warmer near the sun. Two fifths of `β` belong to molecules and scatter
//! blue more than red; the rest belongs to droplets, which are all the same to them. Haze thins with height, by the
//! factor e every [`SCALE_HEIGHT`] metres, and the sum over a straight ray is taken exactly. Where land and sea go on to
//! the horizon, a ray leads through no more air than up to there: the Earth is round, though the ground is drawn even.

use super::sky::{LOWEST, Sky};
use super::terrain::Ray;
use super::vector::{Vector, add, filter};

/// `-ln 0.02`: what is left of the contrast at the visibility.
const CONTRAST: f32 = 3.912;

/// Extinction of red, green and blue, relative to green.
pub(super) const TINT: Vector = [0.77, 1.0, 1.58];

/// Height over which the haze thins by the factor e, in metres.
const SCALE_HEIGHT: f32 = 1800.0;

/// Radius of the Earth in metres.
const EARTH: f32 = 6.36e6;

/// Least distance of the horizon: land that is higher is seen beyond that of even ground.
const NEAREST_HORIZON: f32 = 60_000.0;

/// Scale heights above which there is no haze to speak of.
const ALL_OF_IT: f32 = 6.0;

/// Metres through which one sees at least in the haze before the sky: thicker haze lies near the ground, or the sky would be grey
/// over a small landscape.
const ABOVE: f32 = 80_000.0;

/// By how much the haze before ground beyond the horizon grows with the logarithm of its distance.
const BEYOND: f32 = 0.5;

/// Haze over a landscape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Haze {
    /// Extinction of green at the lowest ground, a metre.
    pub(super) extinction: f32,
    pub(super) scale_height: f32,
    /// Metres after which a ray meets no more of it.
    pub(super) reach: f32,
}

impl Haze {
    /// Haze through which one sees so many metres, over heights that are drawn so many times higher.
    pub(super) fn new(visibility: f64, exaggeration: f32) -> Self {
        let scale_height = SCALE_HEIGHT * exaggeration;
        Self { extinction: CONTRAST / visibility as f32, scale_height, reach: f32::INFINITY }
    }

    /// Haze that takes so much, as an optical depth, from light on its way along a ray.
    pub(super) fn of_depth(depth: f32, ray: &Ray, ray_length: f32, exaggeration: f32) -> Self {
        let unit = Self { extinction: 1.0, ..Self::new(1.0, exaggeration) };
        Self { extinction: depth / unit.column(ray, ray_length).max(1e-3), ..unit }
    }

    /// The same up to the horizon of an eye so many metres above the ground.
    pub(super) fn up_to_the_horizon(self, height: f32) -> Self {
        Self { reach: (2.0 * EARTH * height.max(0.0)).sqrt().max(NEAREST_HORIZON), ..self }
    }

    /// The light that arrives at the start of a ray, of `radiance` that starts `ray_length` metres along it.
    #[inline]
    pub(super) fn veil(self, radiance: Vector, ray: &Ray, ray_length: f32, sky: &Sky) -> Vector {
        let depth = self.extinction * self.column(ray, ray_length);
        let through = TINT.map(|tint| libm::expf(-tint * depth));
        let horizon = sky.radiance([ray.direction[0], ray.direction[1], 0.0]);
        let lost = through.map(|through| 1.0 - through);
        add(filter(radiance, through), filter(horizon, lost))
    }

    /// The light that arrives at the start of a ray that leads into the open sky, of `radiance` beyond the haze.
    #[inline]
    pub(super) fn before_sky(self, radiance: Vector, ray: &Ray, sky: &Sky) -> Vector {
        let out =
            Ray { direction: [ray.direction[0], ray.direction[1], ray.direction[2].max(LOWEST)], ..*ray };
        let above = Self { extinction: self.extinction.min(CONTRAST / ABOVE), ..self };
        above.veil(radiance, &out, ALL_OF_IT * self.scale_height / out.direction[2], sky)
    }

    /// Length of the air at the lowest ground that would veil as much. A ray that goes on beyond the horizon has come down
    /// to the ground there already: its air is that of the same heights in a shorter way, which grows with its logarithm, so that
    /// ground that the Earth would hide still pales.
    fn column(self, ray: &Ray, ray_length: f32) -> f32 {
        let start = libm::expf(-ray.from[2].max(0.0) / self.scale_height);
        let climb = ray.direction[2] * ray_length / self.scale_height;
        // (1 - e^-x) / x, which is 1 - x/2 for level rays.
        let mean = if climb.abs() < 1e-3 { 1.0 - 0.5 * climb } else { -libm::expm1f(-climb) / climb };
        let beyond = (ray_length / self.reach).max(1.0);
        start * mean * ray_length.min(self.reach) * (1.0 + BEYOND * libm::logf(beyond))
    }
}

#[cfg(test)]
mod tests {
    use super::super::vector::{towards, unit};
    use super::*;

    fn level(ray_length: f32, visibility: f64) -> Vector {
        let ray = Ray { from: [0.0; 3], direction: [0.0, 1.0, 0.0] };
        Haze::new(visibility, 1.0).veil([0.0; 3], &ray, ray_length, &Sky::new(towards(90.0, 30.0), 0.53))
    }

    #[test]
    fn nothing_changes_in_endless_visibility_and_little_is_left_at_the_visibility() {
        assert_eq!(level(10_000.0, f64::INFINITY), [0.0; 3]);
        let horizon = Sky::new(towards(90.0, 30.0), 0.53).radiance([0.0, 1.0, 0.0]);
        let share = level(20_000.0, 20_000.0)[1] / horizon[1];
        assert!((share - 0.98).abs() < 1e-3, "{share}");
    }

    #[test]
    fn a_level_ray_meets_little_more_haze_than_up_to_the_horizon() {
        let (ray, sky) = (
            Ray { from: [0.0, 0.0, 1000.0], direction: [0.0, 1.0, 0.0] },
            Sky::new(towards(90.0, 30.0), 0.53),
        );
        let haze = Haze::new(90_000.0, 1.0).up_to_the_horizon(1000.0);
        let seen = |ray_length: f32| haze.veil([0.0; 3], &ray, ray_length, &sky)[1];
        // From 1000 m the sea ends at 113 km.
        let depth = |ray_length: f32| haze.column(&ray, ray_length);
        assert_eq!(depth(100_000.0), 2.0 * depth(50_000.0));
        assert!((1.1..1.5).contains(&(depth(200_000.0) / depth(113_000.0))) && seen(113_000.0) < seen(1e6));
    }

    #[test]
    fn the_sky_pales_towards_the_horizon_without_a_step() {
        let sky = Sky::new(towards(90.0, 30.0), 0.53);
        let haze = Haze::new(60_000.0, 1.0).up_to_the_horizon(2000.0);
        let ray = |rise: f32| Ray { from: [0.0, 0.0, 2000.0], direction: unit([0.0, 1.0, rise]) };
        let bare = |rise: f32| sky.radiance(ray(rise).direction)[0];
        let seen = |rise: f32| haze.before_sky(sky.radiance(ray(rise).direction), &ray(rise), &sky)[0];
        let plain = sky.radiance([0.0, 1.0, 0.0])[0];
        assert!((seen(0.001) / plain - 1.0).abs() < 0.01, "{} of {plain}", seen(0.001));
        let steepest = |of: &dyn Fn(f32) -> f32| {
            let steps = (1..60_u8).map(|at| 0.002 * f32::from(at));
            steps.map(|rise| 1.0 - of(rise + 0.002) / of(rise)).fold(0.0, f32::max)
        };
        let [hazy, clear] = [steepest(&seen), steepest(&bare)];
        assert!(hazy < 0.6 * clear, "by steps of {hazy}, not {clear}");
    }

    #[test]
    fn even_ground_pales_up_to_the_horizon_from_any_height() {
        let sky = Sky::new(towards(90.0, 30.0), 0.53);
        for height in [10.0, 300.0, 2000.0, 12_000.0] {
            let haze = Haze::new(150_000.0, 1.0).up_to_the_horizon(height);
            let dark = |distance: f32| {
                let direction = unit([0.0, distance, -height]);
                let ray = Ray { from: [0.0, 0.0, height], direction };
                haze.veil([0.0; 3], &ray, distance.hypot(height), &sky)[1]
            };
            let paler: Vec<f32> = (0..40).map(|at| dark(1000.0 * 1.3_f32.powi(at))).collect();
            assert!(paler.windows(2).all(|pair| pair[1] >= 0.999 * pair[0]), "{height} m: {paler:?}");
        }
    }

    #[test]
    fn a_steep_ray_meets_the_haze_that_many_short_pieces_of_it_meet() {
        let haze = Haze::new(5000.0, 1.0);
        let ray = Ray { from: [0.0, 0.0, 4000.0], direction: [0.6, 0.0, -0.8] };
        let pieces = (0..5000).map(|metre| {
            let height = 4000.0 - 0.8 * (metre as f32 + 0.5);
            libm::expf(-height / SCALE_HEIGHT)
        });
        let sum: f32 = pieces.sum();
        assert!((haze.column(&ray, 5000.0) / sum - 1.0).abs() < 1e-3);
    }
}
