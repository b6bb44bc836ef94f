//! A perspective view of a landscape: sun and sky, shadows, haze, water, and ground coloured by what grows and lies on
//! it; all on the processor.
//!
//! Each pixel follows a few rays of light backwards to what they met: a patch of the smooth ground ([`terrain`]), a cut
//! side, the plain on which the landscape stands like a model, or the sky. What they met is lit by the sun, as far as
//! the horizon towards it leaves its disc free, and by the visible part of the sky ([`skylight`]); water mirrors both
//! and the land; on the way to the eye light pales in the haze. Pixels depend on their place alone, so any number of
//! threads gives the same picture.

mod albedo;
mod atmosphere;
mod bare_rock;
mod beyond;
mod border;
mod camera;
mod clouds;
mod cover;
mod crags;
mod crown_relief;
mod drawn_rivers;
mod facets;
mod flow;
mod follow;
mod fractures;
mod ground_kinds;
mod ground_noise;
mod haze;
mod horizon;
mod horizons;
mod intersection;
mod keys;
mod lit_scene;
mod lit_water;
mod maps;
mod materials;
mod numbers;
mod pixel_mean;
mod pyramid;
mod refined;
mod rim;
mod rock;
mod scene;
mod scree;
mod setting;
mod side;
mod site;
mod sky;
mod skylight;
mod slope_grain;
mod snow;
mod solid_grain;
mod surface;
mod surroundings;
mod terrain;
mod tone;
mod trees;
mod turf;
mod twin;
#[doc(hidden)]
pub mod twin_calls;
mod vector;
mod water;
mod wooded;
mod woods;

pub use albedo::albedo;
pub use camera::Camera;
pub use follow::Follow;
pub use keys::{Around, GroundColour, View};
pub use lit_scene::LitScene;
pub use maps::{SceneTexture, TextureKind};
pub(crate) use refined::most_cells;
pub use rim::Rim;
pub use scene::RayMarcher;
pub use surroundings::HeightsBeyond;
pub use terrain::Ray;
pub use woods::{SPACING as SPACING_OF_TREES, Tree};

use rayon::prelude::*;

use super::Image;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::landscape::Landscape;

/// Most pixels of a view, and most rays.
const MAX_PIXELS: u64 = 1 << 27;
const MAX_RAYS: u64 = 1 << 32;

impl View {
    /// The view from another camera than its own.
    ///
    /// # Errors
    /// As [`Picture::render`](crate::Picture::render).
    pub fn seen_from(&self, landscape: &Landscape, camera: Camera) -> Result<Image, Error> {
        self.drawn(landscape, Some(camera))
    }

    pub(super) fn drawn(&self, landscape: &Landscape, from: Option<Camera>) -> Result<Image, Error> {
        self.check()?;
        let marcher = RayMarcher::new(self, landscape, from)?;
        let (width, height) = (self.width as usize, self.height as usize);
        let mut rgb = vec![0; 3 * width * height];
        rgb.par_chunks_mut(3 * width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
                pixel.copy_from_slice(&marcher.pixel([x, y]));
            }
        });
        Ok(Image { width, height, rgb })
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        let pixels = u64::from(self.width) * u64::from(self.height);
        let rays = pixels * u64::from(self.samples);
        let limit = match (pixels, rays) {
            (..=MAX_PIXELS, ..=MAX_RAYS) => return Ok(()),
            (..=MAX_PIXELS, _) => Limit::new(Quantity::Rays, rays, 0..=MAX_RAYS),
            _ => Limit::new(Quantity::Pixels, pixels, 0..=MAX_PIXELS),
        };
        let Self { width, height, samples, .. } = self;
        let subject = format!("a view of {width} × {height} pixels with {samples} rays each");
        Err(limit.of(subject).remedy("choose a smaller `width`, `height` or `samples`").into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_over_the_limit_say_whether_pixels_or_rays_are_too_many() {
        let limit = |view: View| match view.check() {
            Err(Error::Limit(limit)) => (limit.what, limit.asked, *limit.allowed.end()),
            other => panic!("{other:?}"),
        };
        let [width, height] = [16384, 16384];
        let large = View { width, height, samples: 1, ..View::default() };
        assert_eq!(limit(large), (Quantity::Pixels, Some(1 << 28), MAX_PIXELS));
        let fine = View { width: width / 2, height, samples: 64, ..View::default() };
        assert_eq!(limit(fine), (Quantity::Rays, Some(1 << 33), MAX_RAYS));
    }
}
