//! What tests ask of a renderer.

use std::sync::Arc;

use weald::Error;
use weald::picture::{Camera, Image};
use wgpu::CommandEncoderDescriptor;

use super::picture::Readback;
use super::renderer::{Renderer, TestLook};

impl Renderer {
    /// As [`Renderer::render`] with what tests look for.
    #[doc(hidden)]
    pub fn render_for_a_test(&mut self, camera: &Camera, look: TestLook) -> Result<Image, Error> {
        self.look = look;
        let image = self.render(camera);
        self.look = TestLook::default();
        image
    }

    /// Two pictures that are encoded one after the other before either is drawn.
    #[doc(hidden)]
    pub fn two_for_a_test(&mut self, cameras: [&Camera; 2]) -> Result<[Image; 2], Error> {
        let landing = || Readback::new(&self.gpu, self.own.options.size);
        let landings = [landing()?, landing()?];
        let context = self.gpu.context.clone();
        context.attempt("drawing", || {
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            for (camera, landing) in cameras.into_iter().zip(&landings) {
                self.encode(camera, &mut encoder, &landing.view)?;
                landing.collect(&mut encoder);
            }
            context.queue.submit([encoder.finish()]);
            Ok(())
        })?;
        let [one, other] = landings;
        Ok([one.image(&self.gpu)?, other.image(&self.gpu)?])
    }

    /// The same without the picture: only chooses what is to be drawn.
    #[doc(hidden)]
    pub fn choose_for_a_test(&mut self, camera: &Camera, look: TestLook) -> Result<(), Error> {
        let context = self.gpu.context.clone();
        self.look = look;
        let chosen = context.attempt("choosing", || {
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.aim((&Arc::clone(&self.own), true), (camera, None), &mut encoder)?;
            context.queue.submit([encoder.finish()]);
            Ok(())
        });
        self.look = TestLook::default();
        chosen
    }

    /// Where the roots of the trees of woods are that stand around the camera of the last picture.
    #[doc(hidden)]
    pub fn trees_for_a_test(&self) -> Result<Vec<[f32; 3]>, Error> {
        self.plants.as_ref().map_or_else(|| Ok(Vec::new()), |plants| plants.trees(&self.gpu))
    }

    /// The list and number of each plant of the last picture, set by set.
    #[doc(hidden)]
    pub fn chosen_for_a_test(&self) -> Result<Vec<Vec<[u32; 2]>>, Error> {
        self.plants.as_ref().map_or_else(|| Ok(Vec::new()), |plants| plants.chosen(&self.gpu))
    }
}
