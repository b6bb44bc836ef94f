//! Pictures of a window: drawn without waiting, and never read back.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, PoisonError};
use std::time::Duration;

use weald::Error;
use weald::picture::{Camera, Image};
use web_time::Instant;
use wgpu::{CommandEncoderDescriptor, TextureFormat, TextureUsages, TextureView};

use super::onto::Onto;
use super::picking::{LandScale, Pick, Picking};
use super::picture::Readback;
use super::renderer::{Renderer, Shot};
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;

/// What one view of a window is drawn onto: a texture that the window shows, and all that is kept for that view. A renderer
/// may have several, of any sizes, and draw each from its own camera.
#[derive(Debug)]
pub struct Screen {
    gpu: Gpu,
    onto: Onto,
    canvas: Canvas,
    picking: Picking,
    scale: LandScale,
    in_flight: Arc<AtomicUsize>,
    submitting: Duration,
}

impl Screen {
    /// The texture of the last picture, in `Rgba8Unorm` with values in sRGB encoding, as egui wants it. It is another one
    /// after [`Renderer::resize_screen`].
    pub fn view(&self) -> &TextureView {
        &self.canvas.view
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.onto.options.size
    }

    /// Pictures that were submitted and are not drawn yet, as far as the device has said: a window on a slow device waits
    /// with the next while there are two.
    pub fn in_flight(&self) -> usize {
        self.in_flight.load(Ordering::Acquire)
    }

    /// Whether the last picture is what more of them from the same camera would be. One of a camera that has just moved takes
    /// some light from those before; a few pictures later all of it is its own.
    pub fn is_settled(&self) -> bool {
        self.onto.reprojection.lock().unwrap_or_else(PoisonError::into_inner).is_settled()
    }

    /// Asks with the next picture what is seen at a place, in pixels rightward and downward from the upper left corner: at
    /// [0.5, 0.5] is the middle of the first pixel. Grass and plants are looked through.
    pub fn ask(&mut self, at: [f32; 2]) {
        self.picking.ask(at);
    }

    /// What was asked and is answered by now, in the order of asking; waits for nothing. An answer comes some pictures
    /// later, and is of the picture with which it was asked.
    ///
    /// # Errors
    /// [`Error::Device`] where the device has failed.
    pub fn answers(&mut self) -> Result<Vec<Pick>, Error> {
        self.gpu.context.tend("picking")?;
        self.picking.answers(&self.scale)
    }

    /// How long the driver took the last picture from us: software draws it then and there.
    #[doc(hidden)]
    pub fn submitting_for_a_test(&self) -> Duration {
        self.submitting
    }

    /// The last picture, read back: to be saved, not to be shown. Waits until it is drawn.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn image(&self) -> Result<Image, Error> {
        let landing = Readback::of(&self.gpu, &self.canvas)?;
        let context = &self.gpu.context;
        context.attempt("reading a picture", || {
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            landing.collect(&mut encoder);
            context.queue.submit([encoder.finish()]);
            Ok(())
        })?;
        landing.image(&self.gpu)
    }
}

impl Renderer {
    /// A view of a window, of such a size in pixels, with as many samples as the renderer has.
    ///
    /// # Errors
    /// [`Error::Limit`] for a size that the device does not have, [`Error::Device`] where its memory does not suffice.
    pub fn screen(&mut self, size: [u32; 2]) -> Result<Screen, Error> {
        self.film.compile(&self.gpu, FORMAT)?;
        let picks = self.passes.picks(&self.gpu)?;
        let onto = self.onto(size, Arc::default())?;
        let picking = Picking::new(&self.gpu, picks, &onto.targets)?;
        let canvas = canvas(&self.gpu, size)?;
        let (gpu, scale, in_flight) = (self.gpu.clone(), self.scale, Arc::default());
        Ok(Screen { gpu, onto, canvas, picking, scale, in_flight, submitting: Duration::ZERO })
    }

    /// Gives a view another size. All that was made of the scene stays, and so do answers on their way.
    ///
    /// # Errors
    /// As [`Renderer::screen`]; the size is then as it was.
    pub fn resize_screen(&self, screen: &mut Screen, size: [u32; 2]) -> Result<(), Error> {
        if size == screen.size() {
            return Ok(());
        }
        let onto = self.onto(size, Arc::clone(&screen.onto.viewer))?;
        screen.canvas = canvas(&self.gpu, size)?;
        screen.picking.aim_at(&self.gpu, &onto.targets);
        screen.onto = onto;
        Ok(())
    }

    /// Draws the picture of a camera on the texture of a view: submits it, and waits for nothing. What is wrong with it is
    /// an error of a later call. Grass around a camera that has come far is sown meanwhile, and stands some pictures later.
    ///
    /// # Errors
    /// [`Error::Run`] for a camera whose numbers are not finite, [`Error::Device`] where the device has failed.
    pub fn draw_on(&mut self, screen: &mut Screen, camera: &Camera) -> Result<(), Error> {
        let target = screen.canvas.view.clone();
        self.draw_into(screen, camera, &target)
    }

    /// As [`Renderer::draw_on`], into another texture of the view's size. The shader writes values in sRGB encoding: the
    /// format is `Rgba8Unorm` or `Bgra8Unorm`, not `…Srgb`. The first picture of another format than `Rgba8Unorm` compiles a
    /// pipeline.
    ///
    /// # Errors
    /// As [`Renderer::draw_on`].
    pub fn draw_into(
        &mut self,
        screen: &mut Screen,
        camera: &Camera,
        target: &TextureView,
    ) -> Result<(), Error> {
        let context = Arc::clone(&self.gpu.context);
        context.tend("drawing")?;
        let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let Screen { onto, picking, in_flight, .. } = screen;
        let picking = picking.is_due().then_some(picking);
        let shot = Shot { onto, camera, target, waits: false };
        self.draw_shot(&mut encoder, &shot, picking)?;
        in_flight.fetch_add(1, Ordering::AcqRel);
        let done = Arc::clone(in_flight);
        encoder.on_submitted_work_done(move || {
            done.fetch_sub(1, Ordering::AcqRel);
        });
        let commands = encoder.finish();
        let begun = Instant::now();
        context.queue.submit([commands]);
        screen.submitting = begun.elapsed();
        screen.picking.submitted();
        Ok(())
    }
}

/// Format of what a window shows.
const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;

fn canvas(gpu: &Gpu, size: [u32; 2]) -> Result<Canvas, Error> {
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    Canvas::new(gpu, "a view of a window", Shape::flat(size, FORMAT, usage))
}
