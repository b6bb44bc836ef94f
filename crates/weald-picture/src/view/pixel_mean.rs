//! The mean light of the rays of a pixel, and whether more of them would change it.
//!
//! Of a sky or an even slope a few rays tell what six do. Rays are marched until the standard error of their mean, in
//! brightness as it is seen, is below a limit (sequential sampling; for pictures: D. P. Mitchell 1987, "Generating
//! antialiased images at low sampling densities", doi 10.1145/37402.37410). Which pixels take more rays depends on the
//! pixel alone.

use super::vector::{Vector, add, scale};

/// Rays before which nothing is known of their spread.
const FEWEST: u32 = 3;

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
        self.rays >= FEWEST && spread <= rays * ERROR * ERROR
    }

    /// The light of all rays alike.
    pub(super) fn light(&self) -> Vector {
        scale(self.sum, 1.0 / self.rays as f32)
    }
}
