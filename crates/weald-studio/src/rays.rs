//! The landscape in the window where there is no device: rays are marched on the processor, some rows of a picture in each
//! frame, coarse first.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use weald::engine::Engine;
use weald::picture::{Camera, Image, LitScene, RayMarcher, View};
use weald::{Error, Landscape};
use web_time::Instant;

use crate::drawing::Drawing;
use crate::work::{Shown, Surface};

/// How long rays are marched in a frame.
const SLICE: Duration = Duration::from_millis(20);

/// Parts of the full width and height that pictures are drawn at, coarse to fine.
const PARTS: [f32; 5] = [1.0 / 16.0, 0.125, 0.25, 0.5, 1.0];

/// What a picture may take while something moves, and when all rests, in seconds.
const MOVING: f64 = 0.12;
const AT_REST: f64 = 20.0;

/// How much longer a scene is looked at than it took to make, while a simulation runs, and how long at least.
const LOOKED_AT: f64 = 3.0;
const LEAST_SECONDS: f64 = 0.6;

/// A landscape that is to be drawn.
struct Wanted {
    landscape: Arc<Landscape>,
    view: View,
    number: (u64, u64),
}

/// A landscape that is drawn.
struct Scene {
    marcher: RayMarcher,
    landscape: Arc<Landscape>,
    view: View,
    number: (u64, u64),
    /// When it was made, and how long that took.
    made: (Instant, Duration),
    /// The surface of a simulation that it shows.
    surface: u64,
}

impl Scene {
    fn new(wanted: Wanted) -> Result<Self, Error> {
        let began = Instant::now();
        let Wanted { landscape, view, number } = wanted;
        let marcher = RayMarcher::of(LitScene::new(&view, &landscape)?, [16, 16]);
        Ok(Self { marcher, landscape, view, number, made: (Instant::now(), began.elapsed()), surface: 0 })
    }

    fn row(&mut self, camera: &Camera, size: [usize; 2], y: usize) -> Vec<u8> {
        self.marcher.look_from(*camera, size);
        self.marcher.row(y)
    }
}

/// A picture of which some rows are done.
struct Picture {
    part: usize,
    size: [usize; 2],
    rgb: Vec<u8>,
    pinned: Vec<u8>,
    seconds: f64,
}

impl Picture {
    fn begin(part: usize, full: [u32; 2]) -> Self {
        let size = full.map(|side| ((side as f32 * PARTS[part]) as usize).max(8));
        Self { part, size, rgb: Vec::new(), pinned: Vec::new(), seconds: 0.0 }
    }

    fn rows(&self) -> usize {
        self.rgb.len() / (3 * self.size[0])
    }
}

/// Draws by rays.
pub(crate) struct Rays {
    context: Context,
    wanted: Option<Wanted>,
    scene: Option<Scene>,
    pinned: Option<Scene>,
    ordered: Option<(u64, u64)>,
    looked: Option<(Camera, [u32; 2])>,
    picture: Option<Picture>,
    /// Which of the parts fits a picture while something moves, and which was drawn last.
    moving: usize,
    drawn: Option<usize>,
    /// Whether no picture was made since something changed.
    is_behind: bool,
    textures: [Option<TextureHandle>; 2],
    seconds: f64,
    /// Seconds that a finer picture may take when all rests.
    at_rest: f64,
    error: Option<String>,
}

impl Rays {
    /// In the window of a context, with pictures at rest that are as fine as their place, or as the processor is quick.
    pub(crate) fn new(context: &Context, finest: bool) -> Self {
        Self {
            context: context.clone(),
            wanted: None,
            scene: None,
            pinned: None,
            ordered: None,
            looked: None,
            picture: None,
            moving: 0,
            drawn: None,
            is_behind: false,
            textures: [None, None],
            seconds: 0.0,
            at_rest: if finest { f64::INFINITY } else { AT_REST },
            error: None,
        }
    }

    /// Begins again, as coarse as it must be to follow.
    fn restart(&mut self) {
        self.begin(self.moving);
        self.drawn = None;
    }

    fn begin(&mut self, part: usize) {
        self.picture = self.looked.map(|(_, full)| Picture::begin(part, full));
        self.is_behind = true;
    }

    /// Marches rows until the slice of time is over or the picture is done.
    fn march(&mut self, camera: &Camera) {
        let (Some(scene), Some(picture)) = (&mut self.scene, &mut self.picture) else { return };
        let began = Instant::now();
        while picture.rows() < picture.size[1] && began.elapsed() < SLICE {
            let y = picture.rows();
            picture.rgb.extend(scene.row(camera, picture.size, y));
            if let Some(pinned) = &mut self.pinned {
                // Heights of a scene count from its own lowest ground.
                let heights = [pinned.marcher.scene(), scene.marcher.scene()].map(|of| of.drawn_height(0.0));
                let [east, north, up] = camera.eye;
                let camera = camera.at([east, north, up + heights[0] - heights[1]]);
                picture.pinned.extend(pinned.row(&camera, picture.size, y));
            }
        }
        picture.seconds += began.elapsed().as_secs_f64();
    }

    /// Shows a picture that is done, and begins a finer one where that does not take too long.
    fn finish(&mut self, full: [u32; 2]) {
        let Some(picture) = self.picture.take_if(|picture| picture.rows() == picture.size[1]) else { return };
        for (place, rgb) in [&picture.rgb, &picture.pinned].into_iter().enumerate() {
            if !rgb.is_empty() {
                self.show(place, ColorImage::from_rgb(picture.size, rgb));
            }
        }
        (self.seconds, self.drawn, self.is_behind) = (picture.seconds, Some(picture.part), false);
        let finer = |part: usize| f64::from(PARTS[part] / PARTS[picture.part]).powi(2) * picture.seconds;
        self.moving = (0..PARTS.len()).rev().find(|&part| finer(part) < MOVING).unwrap_or(0);
        let next = picture.part + 1;
        if next < PARTS.len() && finer(next) < self.at_rest {
            self.picture = Some(Picture::begin(next, full));
        }
    }

    fn show(&mut self, place: usize, image: ColorImage) {
        match &mut self.textures[place] {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            none => {
                *none = Some(self.context.load_texture("landscape", image, TextureOptions::LINEAR));
            }
        }
    }
}

impl Drawing for Rays {
    fn engine(&self) -> Engine {
        Engine::Cpu
    }

    fn is_software(&self) -> bool {
        true
    }

    fn device(&self) -> String {
        "rays on the processor".to_owned()
    }

    fn seconds(&self) -> f64 {
        self.seconds
    }

    fn error(&self) -> Option<String> {
        self.error.clone()
    }

    fn fail(&mut self, error: &Error) {
        self.error = Some(error.to_string());
    }

    fn order(&mut self, shown: &Shown, looks: (&View, u64), _: bool) {
        let number = (shown.number, looks.1);
        if self.ordered != Some(number) {
            self.ordered = Some(number);
            let (landscape, view) = (Arc::clone(&shown.landscape), looks.0.clone());
            self.wanted = Some(Wanted { landscape, view, number });
        }
    }

    fn pin(&mut self, kept: Option<(&Shown, View)>) {
        self.pinned = None;
        self.textures[1] = None;
        if let Some((shown, view)) = kept {
            let landscape = Arc::clone(&shown.landscape);
            match Scene::new(Wanted { landscape, view, number: (shown.number, 0) }) {
                Ok(scene) => self.pinned = Some(scene),
                Err(error) => self.fail(&error),
            }
        }
        self.restart();
    }

    fn take_built(&mut self) {
        let Some(wanted) = self.wanted.take() else { return };
        match Scene::new(wanted) {
            Ok(scene) => {
                (self.scene, self.error) = (Some(scene), None);
                self.restart();
            }
            Err(error) => self.fail(&error),
        }
    }

    fn whole(&self) -> Option<Camera> {
        self.scene.as_ref().map(|scene| {
            let lit = scene.marcher.scene();
            lit.camera_of(&scene.view)
        })
    }

    fn middle(&self) -> Option<[f32; 3]> {
        self.scene.as_ref().map(|scene| scene.marcher.scene().middle())
    }

    fn drawn_height(&self, elevation: f64) -> Option<f32> {
        self.scene.as_ref().map(|scene| scene.marcher.scene().drawn_height(elevation))
    }

    fn follow(&mut self, surface: &Surface) -> Result<(), Error> {
        let Some(scene) = &mut self.scene else { return Ok(()) };
        if scene.number.0 != surface.shown || scene.surface == surface.number {
            return Ok(());
        }
        let (made, took) = scene.made;
        let least = (LOOKED_AT * took.as_secs_f64()).max(LEAST_SECONDS);
        if self.is_behind || made.elapsed().as_secs_f64() < least {
            self.context.request_repaint_after(took);
            return Ok(());
        }
        let began = Instant::now();
        let mut landscape = (*scene.landscape).clone();
        landscape.insert("height", "m", (*surface.ground).clone());
        landscape.insert("water", "m", surface.canvas.water.clone());
        let lit = scene.marcher.scene().changed(&scene.view, &landscape)?;
        scene.marcher = RayMarcher::of(lit, [16, 16]);
        scene.made = (Instant::now(), began.elapsed());
        scene.surface = surface.number;
        // As fine as the last picture, which stands until this one is done, unless that would take long.
        let fine = |part: usize| f64::from(PARTS[part] / PARTS[self.moving]).powi(2) * MOVING < LEAST_SECONDS;
        let part = (0..=self.drawn.unwrap_or(0)).rev().find(|&part| fine(part)).unwrap_or(self.moving);
        self.begin(part);
        Ok(())
    }

    fn draw(&mut self, camera: &Camera, full: [u32; 2]) -> Result<Option<Duration>, Error> {
        if self.looked != Some((*camera, full)) {
            self.looked = Some((*camera, full));
            self.restart();
        }
        self.march(camera);
        self.finish(full);
        Ok(self.picture.is_some().then_some(Duration::ZERO))
    }

    fn is_drawn(&self, number: Option<(u64, u64)>) -> bool {
        let is_there = self.scene.as_ref().map(|scene| scene.number) == number;
        is_there && self.drawn.is_some() && self.picture.is_none()
    }

    fn texture(&self) -> Option<TextureId> {
        self.textures[0].as_ref().map(TextureHandle::id)
    }

    fn pinned_texture(&self) -> Option<TextureId> {
        self.pinned.as_ref().and(self.textures[1].as_ref()).map(TextureHandle::id)
    }

    fn has_pinned(&self) -> bool {
        self.pinned.is_some()
    }

    fn picture(&mut self, camera: &Camera, size: [u32; 2]) -> Result<Option<Image>, Error> {
        let Some(scene) = &self.scene else { return Ok(None) };
        let [width, height] = size;
        let view = View { width, height, ..scene.view.clone() };
        view.seen_from(&scene.landscape, *camera).map(Some)
    }
}
