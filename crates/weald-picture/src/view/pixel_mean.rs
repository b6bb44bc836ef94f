//! The mean light of the rays of a pixel, and whether more of them would change it.
//!
//! Of a sky or an even slope a few rays tell what six do. Rays are marched until the standard error of their mean, in
//! brightness as it is seen, is below a limit (sequential sampling; for pictures: D. P. Mitchell 1987, "Generating
//! antialiased images at low sampling densities", doi 10.1145/37402.37410). Which pixels take more rays depends on the
//! pixel alone.

use super::vector::{Vector, add, scale};

/// Rays before which nothing is known of their spread.
const LEAST_RAYS: u32 = 3;

/// Standard error of a mean that is good enough, as a share of white: less than the noise that bytes are dithered with.
const ERROR: f32 = 0.01;

/// A mean that grows ray by ray.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PixelMean {
    sum: Vector,
    rays: u32,
    brightness: f32,
    squares: f32,
}

impl PixelMean {
    /// Takes the light of a ray, and how bright it is on the screen, 0 to 1.
    pub(super) fn add(&mut self, light: Vector, brightness: f32) {
        self.sum = add(self.sum, light);
        self.rays += 1;
        self.brightness += brightness;
        self.squares += brightness * brightness;
    }

    /// Whether more rays would hardly change it.
    pub(super) fn is_known(&self) -> bool {
        let rays = self.rays as f32;
        let spread = (self.squares - self.brightness * self.brightness / rays).max(0.0) / (rays - 1.0);
        self.rays >= LEAST_RAYS && spread <= rays * ERROR * ERROR
    }

    /// The light of all rays alike.
    pub(super) fn light(&self) -> Vector {
        scale(self.sum, 1.0 / self.rays as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many rays of those brightnesses are marched.
    fn rays(brightnesses: &[f32]) -> usize {
        let mut mean = PixelMean::default();
        let known = |&brightness: &f32| {
            mean.add([brightness; 3], brightness);
            mean.is_known()
        };
        brightnesses.iter().position(known).map_or(brightnesses.len(), |last| last + 1)
    }

    #[test]
    fn an_even_pixel_takes_three_rays_and_an_edge_all() {
        assert_eq!(rays(&[0.5; 6]), 3);
        assert_eq!(rays(&[0.50, 0.51, 0.49, 0.5, 0.5, 0.5]), 3, "noise of a step of bytes or two");
        assert_eq!(rays(&[0.2, 0.2, 0.6, 0.6, 0.2, 0.6]), 6);
        assert_eq!(rays(&[0.50, 0.54, 0.50, 0.50, 0.50, 0.50]), 5, "what was seen once fades among more");
    }

    #[test]
    fn the_light_is_the_mean_of_all_that_were_marched() {
        let mut mean = PixelMean::default();
        for light in [[1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [0.5, 0.5, 0.5]] {
            mean.add(light, 0.5);
        }
        assert_eq!(mean.light(), [0.5; 3]);
    }
}
