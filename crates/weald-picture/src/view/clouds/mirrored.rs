//! Clouds as rippled water mirrors them, by one look at the broad noise of their heaps.
//!
//! A heap is taken for as high as its noise `w`, less by `N s²` at a share `s` of the layer's height, stays above 0; what hides the sky
//! is the sum of the noise up to there:
//!
//! ```text
//! ∫ (w - N s²) ds = t (w - N t² / 3)      t = min(√(w / N), 1)
//! ```
//!
//! Puffs, which ripples blur, are left out. All numbers are chosen by eye.

use super::{BROADEST, CloudLight, Clouds, FLATTEST, GLOW, LOST, NARROWER, SUNNY, THICK, THROUGH};
use crate::view::sky::Sky;
use crate::view::terrain::Ray;
use crate::view::vector::{add, dot, scale};

/// The angle in radians over which ripples blur them, the noise around that of a side over which it
/// is so soft, what a metre of a heap hides for each unit of noise, the share of it that ripples show, which mirror clear sky
/// beside it, and what a unit of noise takes of the sunlight.
const MIRRORED_BLUR: f32 = 0.12;
const MIRRORED_SOFT: f32 = 0.25;
const MIRRORED_DENSE: f32 = 0.02;
const MIRRORED_SHARE: f32 = 0.165;
const MIRRORED_TAKEN: f32 = 5.0;

impl Clouds {
    /// The clouds along a ray that rippled water mirrors: heaps without puffs, that are as high as their noise is above that of
    /// their sides.
    pub(in crate::view) fn mirrored(&self, sky: &Sky, ray: &Ray) -> CloudLight {
        let rise = ray.direction[2];
        if rise < FLATTEST[0] || ray.from[2] >= self.height {
            return CloudLight::NONE;
        }
        let reach = (self.height + BROADEST * THICK * self.exaggeration - ray.from[2]) / rise;
        let [x, y, _] = ray.at(reach);
        let heap = self.heap([x, y], BROADEST, MIRRORED_BLUR * reach);
        let soft = (heap + MIRRORED_SOFT).max(0.0);
        let within = heap.max(0.25 / MIRRORED_SOFT * soft * soft.min(2.0 * MIRRORED_SOFT));
        let top = (within / NARROWER).sqrt().min(1.0);
        let noise = top * (within - NARROWER * top * top / 3.0);
        let hidden = 1.0 - libm::expf(-MIRRORED_DENSE * THICK * self.exaggeration / rise * noise);
        let through = libm::expf(-MIRRORED_TAKEN * within);
        let glow = GLOW * libm::powf(dot(ray.direction, sky.sun).max(0.0), 12.0);
        let light = add(
            scale(sky.sunlight, THROUGH + SUNNY * through + glow),
            scale(self.skylight, 0.7 * std::f32::consts::FRAC_1_PI),
        );
        let shown = hidden * MIRRORED_SHARE * libm::expf(-reach / LOST);
        CloudLight { radiance: scale(light, shown), open: 1.0 - shown }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{clouds, haze};
    use super::*;
    use crate::view::vector::unit;

    #[test]
    fn water_mirrors_about_as_much_of_clouds_as_blurred_ones_would_be() {
        let (sky, clouds) = clouds(0.5);
        let clouds = clouds.expect("some");
        let direction = unit([0.3, 0.2, 0.4]);
        let hidden = |place: usize| {
            let ray = Ray { from: [170.0 * place as f32, 90.0 * place as f32, 0.0], direction };
            let near = clouds.before((&sky, haze()), &ray, 0.001);
            [near.open, clouds.mirrored(&sky, &ray).open].map(|open| 1.0 - open)
        };
        let [seen, mirrored] = (0..800).map(hidden).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        assert!(
            mirrored < 2.0 * MIRRORED_SHARE * seen && mirrored > 0.5 * MIRRORED_SHARE * seen,
            "{mirrored} for {seen}"
        );
    }
}
