//! A scene on a device: what is drawn of it, and in which order.

use std::sync::{Arc, PoisonError};

use weald::grow::Vegetation;
use weald::picture::{Camera, Image, LitScene};
use weald::{Error, Landscape};
use wgpu::{CommandEncoder, TextureView};

use super::canopy;
use super::cascades::CASCADES;
use super::coming::{Coming, SceneUpdate};
use super::follower::Follower;
use super::frame::{Drawn, Frame, PictureBefore};
use super::grass::Grass;
use super::grass_layer::Around;
use super::grass_look::GrassLook;
use super::in_sight::InSight;
use super::layouts::Layouts;
use super::maps::Maps;
use super::onto::Onto;
use super::options::{Options, check_camera};
use super::passes::{Drawing, Passes};
use super::picking::{LandScale, Picking};
use super::picture::Readback;
use super::plants::Plants;
use super::reprojection::{LightBefore, Moment};
use super::shadows::{CascadeContent, Shadows};
use super::terrain::{Shown, Terrain};
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

/// One picture that is to be drawn.
#[derive(Debug)]
pub(super) struct Shot<'a> {
    pub(super) onto: &'a Onto,
    pub(super) camera: &'a Camera,
    pub(super) target: &'a TextureView,
    /// Whether it waits for what it is drawn of.
    pub(super) waits: bool,
}

/// A scene on a device, ready to be drawn from any camera: a picture that comes back by [`Renderer::render`], or the views of
/// a window by [`Renderer::screen`], for which nothing waits.
#[derive(Debug)]
pub struct Renderer {
    pub(super) gpu: Gpu,
    pub(super) maps: Maps,
    pub(super) frame: Frame,
    pub(super) terrain: Terrain,
    pub(super) grass: Option<Grass>,
    pub(super) grass_look: GrassLook,
    pub(super) plants: Option<Plants>,
    pub(super) passes: Passes,
    pub(super) shadows: Shadows,
    pub(super) canopy: Canvas,
    /// What its own pictures are drawn onto, which it gives back.
    pub(super) own: Arc<Onto>,
    pub(super) film: ToneMapping,
    pub(super) scale: LandScale,
    pub(super) look: TestLook,
    pub(super) timer: Option<Timer>,
    pub(super) follower: Option<Follower>,
    /// What has become of the scene and is not on the device yet.
    pub(super) coming: Option<Coming>,
    /// How often what lights or shades the ground has changed: light of before is then no longer taken.
    pub(super) changes: u64,
    pub(super) has_water: bool,
    /// The height at which clouds begin.
    pub(super) cloud_base: Option<f32>,
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
        Self::with_lawn(gpu, scene, options, false)
    }

    /// Brings a scene to a device with what grows in its landscape: as [`Renderer::new`] and [`Renderer::plant`], but
    /// that what draws the ground is compiled once alone where grass stands on it.
    ///
    /// # Errors
    /// As of both.
    pub fn planted(
        gpu: &Gpu,
        (scene, landscape): (&LitScene, &Landscape),
        options: Options,
    ) -> Result<Self, Error> {
        let mut renderer = Self::with_lawn(gpu, scene, options, has_lawn(landscape))?;
        renderer.plant(scene, landscape)?;
        Ok(renderer)
    }

    fn with_lawn(gpu: &Gpu, scene: &LitScene, options: Options, has_lawn: bool) -> Result<Self, Error> {
        options.check(gpu)?;
        let source = scene.textures();
        let maps = Maps::new(gpu, scene, &source)?;
        let terrain = Terrain::new(gpu, scene, &source)?;
        let shadows = Shadows::new(gpu)?;
        let canopy = canopy::none(gpu)?;
        let frame = Frame::new(gpu, &shadows.canvas, &canopy)?;
        let heights = &terrain.patch_heights.layouts;
        let layouts = Layouts { frame: &frame, maps: &maps, cascade: &shadows.layout, heights };
        let passes = Passes::new(gpu, scene, layouts, (options.samples, has_lawn))?;
        let film = ToneMapping::new(gpu, scene, (&frame, &maps))?;
        let own = Arc::new(Onto::new(gpu, (&passes, &film), options, Arc::default())?);
        Ok(Self {
            gpu: gpu.clone(),
            maps,
            frame,
            terrain,
            grass: None,
            grass_look: GrassLook::default(),
            plants: None,
            passes,
            shadows,
            canopy,
            own,
            film,
            scale: LandScale::of(scene),
            look: TestLook::default(),
            timer: None,
            follower: None,
            coming: None,
            changes: 0,
            has_water: scene.has_water(),
            cloud_base: scene.cloud_base(),
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
        if size != self.own.options.size {
            self.own = Arc::new(self.onto(size, Arc::clone(&self.own.viewer))?);
        }
        Ok(())
    }

    /// Canvases of another size.
    pub(super) fn onto(&self, size: [u32; 2], viewer: Arc<()>) -> Result<Onto, Error> {
        let options = Options { size, ..self.own.options };
        Onto::new(&self.gpu, (&self.passes, &self.film), options, viewer)
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
        let heights = &self.terrain.patch_heights.layouts;
        let cascade = &self.shadows.layout;
        let layouts = Layouts { frame: &self.frame, maps: &self.maps, cascade, heights };
        let (has_lawn, samples) = (has_lawn(landscape), self.own.options.samples);
        if has_lawn != self.passes.has_lawn {
            self.passes = Passes::new(&self.gpu, scene, layouts, (samples, has_lawn))?;
        }
        let grown = (scene, landscape);
        self.grass = Grass::new(&self.gpu, grown, layouts, samples)?;
        self.plants = Plants::new(&self.gpu, grown, layouts, samples)?;
        self.forget_light();
        Ok(())
    }

    /// What shades the ground has changed: its shadows are drawn anew, and no picture takes light from the one before.
    pub(super) fn forget_light(&mut self) {
        self.shadows.forget();
        self.changes += 1;
    }

    /// Takes what a scene has become, for the next pictures of a window a few megabytes at a time, for one that comes back
    /// all of it: colours, light of the sky, water and, where no simulation is followed, the ground with what stands on it.
    /// What was on its way before is forgotten.
    ///
    /// # Errors
    /// [`Error::Device`] for a scene of another size or with other surroundings, or where the device's memory does not suffice.
    pub fn update(&mut self, update: SceneUpdate) -> Result<(), Error> {
        let maps = (&self.gpu, &mut self.maps);
        let as_it_is = (self.follower.is_some(), self.terrain.has_horizon());
        self.coming = Some(Coming::new(update, maps, as_it_is)?);
        Ok(())
    }

    /// Sends what is on its way; when all is there, what stands on the ground stands on it anew.
    fn send_coming(&mut self, waits: bool, encoder: &mut CommandEncoder) {
        // Some of its rows are there with each picture: heights of before and after would leave cracks between patches.
        if self.coming.is_some() {
            self.terrain.patch_heights.forget();
            self.changes += 1;
        }
        let is_there = self.coming.as_mut().is_some_and(|coming| coming.send(&self.gpu, &self.maps, waits));
        let Some(coming) = self.coming.take_if(|_| is_there) else { return };
        self.forget_light();
        self.cloud_base = coming.cloud_base();
        if self.follower.is_none() {
            let (heights, errors) = coming.shape();
            self.terrain.take(heights, errors);
            if let Some(plants) = &mut self.plants {
                plants.stand(encoder, [&self.frame.caster_group, &self.maps.group]);
            }
        }
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
        let landing = Readback::new(&self.gpu, self.own.options.size)?;
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
        encoder: &mut CommandEncoder,
        target: &TextureView,
    ) -> Result<(), Error> {
        let onto = &*Arc::clone(&self.own);
        self.draw_shot(encoder, &Shot { onto, camera, target, waits: true }, None)
    }

    /// Encodes a picture, and what is asked of it.
    pub(super) fn draw_shot(
        &mut self,
        encoder: &mut CommandEncoder,
        shot: &Shot<'_>,
        picking: Option<&mut Picking>,
    ) -> Result<(), Error> {
        let Shot { onto, target, .. } = *shot;
        self.send_coming(shot.waits, encoder);
        let now = Moment { camera: *shot.camera, changes: self.changes, seconds: self.seconds };
        let mut view = onto.reprojection.lock().unwrap_or_else(PoisonError::into_inner);
        let mut before = None;
        if let Some(pipelines) = self.passes.reprojection.as_ref().filter(|_| !shot.waits) {
            before = view.begin(&self.gpu, (&pipelines.layouts, &onto.targets), &now)?;
        }
        let (wanted, in_sight) = self.aim((onto, shot.waits), (shot.camera, before), encoder)?;
        let into = &mut Upload { gpu: &self.gpu, encoder };
        let groups = [&self.frame.caster_group, &self.maps.group];
        self.terrain.patch_heights.fill(into, &self.passes.heights, groups)?;
        let timer = self.timer.as_ref();
        let drawing = Drawing {
            terrain: &self.terrain,
            grass: self.grass.as_ref(),
            plants: self.plants.as_ref(),
            bare: self.look.bare,
            casts_nothing: self.look.casts_nothing,
            in_sight,
            before: LightBefore::of(&view, !shot.waits, before.is_some()),
            timer,
        };
        if let Some(timer) = timer {
            timer.begin_shadows(encoder);
        }
        let groups = (&self.frame.cascade_groups, &self.maps.group);
        self.shadows.draw(encoder, groups, (&self.passes.casters, &wanted), drawing);
        let groups = [&self.frame.group, &self.maps.group];
        if let Some(grass) = &self.grass {
            grass.light(encoder, groups);
        }
        if let Some(timer) = timer {
            timer.end_shadows(encoder);
        }
        let pick =
            picking.map(|picking| |encoder: &mut CommandEncoder| picking.encode(&self.gpu, encoder, groups));
        self.passes.draw(encoder, (&onto.targets, &onto.depths), groups, drawing, pick);
        let groups = [&self.frame.caster_group, &self.maps.group, &onto.light];
        self.film.develop(&self.gpu, encoder, (groups, timer), target)?;
        if !shot.waits {
            view.end(now);
        }
        Ok(())
    }

    /// Selects what a camera sees, and encodes the choice of its grass and plants; says what cascades are to hold, and what is
    /// in sight.
    pub(super) fn aim(
        &mut self,
        (onto, waits): (&Onto, bool),
        (camera, before): (&Camera, Option<PictureBefore>),
        encoder: &mut CommandEncoder,
    ) -> Result<([CascadeContent; CASCADES], InSight), Error> {
        let size = onto.options.size;
        check_camera(camera)?;
        if let Some(timer) = &self.timer {
            timer.begin(encoder);
        }
        let into = &mut Upload { gpu: &self.gpu, encoder };
        let from = self.look.detail_from.unwrap_or(camera.eye);
        let tallest = self.plants.as_ref().map_or(0.0, |plants| plants.tallest);
        let nearest = self.terrain.nearest_in_sight(camera, from, tallest);
        let woods = self.plants.as_mut().map_or(0.0, |plants| plants.reach_of_trees(nearest));
        // A simulation that is followed changes the ground on the device, and so do rows that are on their way.
        let heights_are_known = self.follower.is_none() && self.coming.is_none();
        let shown = Shown { detail_from: from, nearest, woods, heights_are_known };
        let drawn = self.terrain.prepare(into, camera, size, shown)?;
        let (seconds, is_dry) = (self.seconds, self.is_dry);
        let look = self.grass_look.of_camera(camera);
        let grass = [look.reach, self.grass.as_ref().map_or(1.0, |grass| grass.whole(look.reach))];
        let mut drawn = Drawn { seconds, is_dry, grass, before, ..drawn };
        let pixel_angle = camera.pixel_angle(size[0] as usize);
        let wanted = CascadeContent::of(&drawn, pixel_angle);
        drawn.stale = self.shadows.stale(&wanted);
        self.frame.write(into, camera, size, &drawn);
        for number in (0..CASCADES).filter(|&number| drawn.stale[number]) {
            let stand = if number == CASCADES - 1 {
                self.terrain.prepare_whole(into, drawn.cascades.last_texel())?;
                drawn.stand
            } else {
                self.terrain.prepare_cascade(into, number, (camera, size), &drawn.cascades)?
            };
            self.frame.write_cascade(into, (number, stand), (camera, size), &drawn);
        }
        let groups = [&self.frame.caster_group, &self.maps.group];
        if let Some(plants) = &mut self.plants {
            plants.grow(encoder, groups, from);
            plants.choose(encoder, groups, drawn.stale);
        }
        if let Some(grass) = &mut self.grass {
            let around = Around { from, camera, look, viewer: &onto.viewer, waits };
            grass.prepare(&self.gpu, &around)?;
            grass.choose(encoder, groups, self.timer.as_ref());
        } else if let Some(timer) = &self.timer {
            timer.skip_choice(encoder);
        }
        let in_sight = InSight::of(camera, self.terrain.above_all(camera), pixel_angle, self.cloud_base);
        Ok((wanted, in_sight))
    }
}

/// Whether grass stands on the ground of a landscape.
fn has_lawn(landscape: &Landscape) -> bool {
    landscape.all_meadows().next().is_some()
}
