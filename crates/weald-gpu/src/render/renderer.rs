//! A scene on a device: what is drawn of it, and in which order.

use weald::grow::Vegetation;
use weald::picture::{Camera, Image, LitScene};
use weald::{Error, Landscape};
use wgpu::BindGroup;

use super::canopy;
use super::follower::Follower;
use super::frame::{Drawn, Frame};
use super::grass::Grass;
use super::grass_look::GrassLook;
use super::ground::depths_group;
use super::layouts::Layouts;
use super::maps::Maps;
use super::options::{Options, check_camera};
use super::passes::{Drawing, Passes};
use super::picture::Readback;
use super::plants::Plants;
use super::shadows::Shadows;
use super::targets::Targets;
use super::terrain::Terrain;
use super::textures::Canvas;
use super::timing::Timer;
use super::tone_mapping::ToneMapping;
use super::upload::Upload;
use crate::gpu::Gpu;

/// What tests look for.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default)]
pub struct TestLook {
    /// Whether what is behind the landscape is magenta.
    pub bare: bool,
    /// Whether nothing throws shadows.
    pub casts_nothing: bool,
    /// From where levels of detail are chosen, in place of the camera's point.
    pub detail_from: Option<[f32; 3]>,
}

/// A scene on a device, ready to be drawn from any camera.
#[derive(Debug)]
pub struct Renderer {
    pub(super) gpu: Gpu,
    pub(super) options: Options,
    pub(super) maps: Maps,
    pub(super) frame: Frame,
    pub(super) terrain: Terrain,
    pub(super) grass: Option<Grass>,
    pub(super) grass_look: GrassLook,
    pub(super) plants: Option<Plants>,
    pub(super) passes: Passes,
    pub(super) shadows: Shadows,
    pub(super) canopy: Canvas,
    pub(super) targets: Targets,
    /// The depths of the ground, as its light is drawn from them.
    pub(super) depths: BindGroup,
    pub(super) film: ToneMapping,
    pub(super) look: TestLook,
    pub(super) timer: Option<Timer>,
    pub(super) follower: Option<Follower>,
    pub(super) has_water: bool,
    /// Whether water is left out, to be measured.
    pub(super) is_dry: bool,
    /// Moment of the next picture, by which water flows.
    pub(super) seconds: f32,
}

impl Renderer {
    /// Brings a scene to a device.
    ///
    /// # Errors
    /// [`Error::Limit`] for a size or number of samples that the device does not have, [`Error::Device`] where its
    /// memory does not suffice or it fails.
    pub fn new(gpu: &Gpu, scene: &LitScene, options: Options) -> Result<Self, Error> {
        options.check(gpu)?;
        let source = scene.textures();
        let maps = Maps::new(gpu, scene, &source)?;
        let terrain = Terrain::new(gpu, scene, &source)?;
        let shadows = Shadows::new(gpu)?;
        let canopy = canopy::none(gpu)?;
        let frame = Frame::new(gpu, &shadows.canvas, &canopy)?;
        let layouts = Layouts { frame: &frame, maps: &maps, cascade: &shadows.layout };
        let passes = Passes::new(gpu, scene, layouts, (options.samples, false))?;
        let targets = Targets::new(gpu, options)?;
        let depths = depths_group(gpu, &passes.depths, &targets);
        let film = ToneMapping::new(gpu, scene, &maps, &targets)?;
        Ok(Self {
            gpu: gpu.clone(),
            options,
            maps,
            frame,
            terrain,
            grass: None,
            grass_look: GrassLook::default(),
            plants: None,
            passes,
            shadows,
            canopy,
            targets,
            depths,
            film,
            look: TestLook::default(),
            timer: None,
            follower: None,
            has_water: scene.has_water(),
            is_dry: false,
            seconds: 0.0,
        })
    }

    /// Draws pictures of another size from now on, as in a window that was pulled larger. What was made of the scene stays;
    /// only what is drawn onto is made anew.
    ///
    /// # Errors
    /// [`Error::Limit`] for a size that the device does not have, [`Error::Device`] where its memory does not suffice; the
    /// size is then as it was.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), Error> {
        if size == self.options.size {
            return Ok(());
        }
        let options = Options { size, ..self.options };
        options.check(&self.gpu)?;
        self.targets = Targets::new(&self.gpu, options)?;
        self.depths = depths_group(&self.gpu, &self.passes.depths, &self.targets);
        self.film.aim_at(&self.gpu, &self.targets);
        self.options = options;
        Ok(())
    }

    /// Plants what grows in the scene's landscape: its grass and scattered plants.
    ///
    /// # Errors
    /// [`Error::Device`] where the device's memory does not suffice or it fails.
    pub fn plant(&mut self, scene: &LitScene, landscape: &Landscape) -> Result<(), Error> {
        if let Some(canopy) = canopy::of(&self.gpu, landscape)? {
            self.frame.plant(&self.gpu, &self.shadows.canvas, &canopy)?;
            self.canopy = canopy;
        }
        let layouts = Layouts { frame: &self.frame, maps: &self.maps, cascade: &self.shadows.layout };
        let has_lawn = landscape.all_meadows().next().is_some();
        self.passes = Passes::new(&self.gpu, scene, layouts, (self.options.samples, has_lawn))?;
        let grown = (scene, landscape);
        self.grass = Grass::new(&self.gpu, grown, layouts, self.options.samples)?;
        self.plants = Plants::new(&self.gpu, grown, layouts, self.options.samples)?;
        self.shadows.whole_is_drawn = false;
        Ok(())
    }

    /// Sets what of the grass the next pictures show.
    pub fn set_grass_look(&mut self, look: GrassLook) {
        self.grass_look = look;
    }

    /// Sets the moment of the next pictures, in seconds: water flows by it.
    pub fn set_time(&mut self, seconds: f32) {
        self.seconds = seconds;
    }

    /// Draws the picture of a camera.
    ///
    /// # Errors
    /// [`Error::Run`] for a camera whose numbers are not finite, [`Error::Device`] where the device fails.
    pub fn render(&mut self, camera: &Camera) -> Result<Image, Error> {
        let landing = Readback::new(&self.gpu, self.options.size)?;
        let context = self.gpu.context.clone();
        context.attempt("drawing", || {
            let mut encoder =
                context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.encode(camera, &mut encoder, &landing.view)?;
            landing.collect(&mut encoder);
            context.queue.submit([encoder.finish()]);
            Ok(())
        })?;
        landing.image(&self.gpu)
    }

    /// Encodes the picture of a camera into a view of the renderer's size. The shader writes values in sRGB encoding: the
    /// format of the view is `Rgba8Unorm` or `Bgra8Unorm`, not `…Srgb`, by which they would be encoded twice.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn encode(
        &mut self,
        camera: &Camera,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
    ) -> Result<(), Error> {
        self.aim(camera, encoder)?;
        let groups =
            [&self.frame.caster_group, &self.frame.still_group].map(|numbers| [numbers, &self.maps.group]);
        let timer = self.timer.as_ref();
        let drawing = Drawing {
            terrain: &self.terrain,
            grass: self.grass.as_ref(),
            plants: self.plants.as_ref(),
            bare: self.look.bare,
            casts_nothing: self.look.casts_nothing,
            timer,
        };
        self.shadows.draw(encoder, groups, &self.passes.casters, drawing);
        let groups = [&self.frame.group, &self.maps.group];
        if let Some(grass) = &self.grass {
            grass.light(encoder, groups);
        }
        if let Some(timer) = timer {
            timer.end_shadows(encoder);
        }
        self.passes.draw(encoder, (&self.targets, &self.depths), groups, drawing);
        self.film.develop(&self.gpu, encoder, (&self.maps, timer), target)
    }

    /// Selects what a camera sees, and encodes the choice of its grass and plants.
    pub(super) fn aim(&mut self, camera: &Camera, encoder: &mut wgpu::CommandEncoder) -> Result<(), Error> {
        check_camera(camera)?;
        if let Some(timer) = &self.timer {
            timer.begin(encoder);
        }
        let into = &mut Upload { gpu: &self.gpu, encoder };
        let drawn = self.terrain.prepare(into, camera, self.options.size, self.look.detail_from)?;
        let drawn = Drawn { seconds: self.seconds, is_dry: self.is_dry, ..drawn };
        self.frame.write(into, camera, self.options.size[0], &drawn);
        if !self.shadows.whole_is_drawn {
            self.terrain.prepare_whole(into, drawn.cascades.last_texel())?;
            self.frame.write_still(into, camera, self.options.size[0], &drawn);
        }
        let groups = [&self.frame.caster_group, &self.maps.group];
        if let Some(plants) = &self.plants {
            plants.choose(encoder, groups);
        }
        if let Some(grass) = &mut self.grass {
            grass.prepare(&self.gpu, self.look.detail_from.unwrap_or(camera.eye), self.grass_look)?;
            grass.choose(encoder, groups, self.timer.as_ref());
        } else if let Some(timer) = &self.timer {
            timer.skip_choice(encoder);
        }
        Ok(())
    }

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
        let landing = || Readback::new(&self.gpu, self.options.size);
        let landings = [landing()?, landing()?];
        let context = self.gpu.context.clone();
        context.attempt("drawing", || {
            let mut encoder =
                context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
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
            let mut encoder =
                context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.aim(camera, &mut encoder)?;
            context.queue.submit([encoder.finish()]);
            Ok(())
        });
        self.look = TestLook::default();
        chosen
    }

    /// The list and number of each plant of the last picture, set by set.
    #[doc(hidden)]
    pub fn chosen_for_a_test(&self) -> Result<Vec<Vec<[u32; 2]>>, Error> {
        self.plants.as_ref().map_or_else(|| Ok(Vec::new()), |plants| plants.chosen(&self.gpu))
    }

    /// How many triangles the ground of a camera takes.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn triangles(&mut self, camera: &Camera) -> Result<u64, Error> {
        check_camera(camera)?;
        let device = &self.gpu.context.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut into = Upload { gpu: &self.gpu, encoder: &mut encoder };
        self.terrain.prepare(&mut into, camera, self.options.size, None)?;
        Ok(self.terrain.triangles())
    }
}
