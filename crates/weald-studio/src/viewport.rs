//! The landscape in the window, drawn on the device that the window itself is drawn with: with [`interface`](crate::interface)
//! the one file of the studio that knows the graphics interface.
//!
//! Scenes are made on a thread of their own, so that the window never waits for one. Pictures are submitted and not waited
//! for; while something moves they are so small that they take a slice of time, and become finer when it rests.

use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;

#[cfg(not(target_arch = "wasm32"))]
use eframe::NativeOptions;
use eframe::egui::{Context, TextureId};
use eframe::egui_wgpu::{RenderState, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::wgpu::{Backends, FilterMode, InstanceFlags};
use weald::edit::Canvas;
use weald::engine::Engine;
use weald::picture::{Camera, Image, View};
use weald::{Error, Field};
use weald_gpu::Gpu;

use crate::drawing::Drawing;
#[cfg(not(target_arch = "wasm32"))]
use crate::interface::Interface;
use crate::scenes::{Order, Scenes, Stage};
use crate::work::{Shown, Surface};

/// What a picture may take while something moves.
const SLICE: f64 = 0.025;

/// What a finer picture may take when all rests: controls that are touched meanwhile wait for it on software.
const AT_REST: f64 = 4.0;

/// Parts of the full width and height that pictures are drawn at, coarse to fine.
const SCALES: [f32; 5] = [0.125, 0.25, 0.5, 0.75, 1.0];

/// How long nothing moves before a finer picture is drawn.
const REST: Duration = Duration::from_millis(200);

/// The device of a window, and what draws its controls.
pub(crate) type WindowDevice = RenderState;

/// The device of a window that is being made.
pub(crate) fn device_of<'a>(context: &'a eframe::CreationContext<'_>) -> Option<&'a WindowDevice> {
    context.wgpu_render_state.as_ref()
}

/// Options of a window whose device has what simulations and pictures need.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn options() -> NativeOptions {
    NativeOptions { wgpu_options: device_options(), ..NativeOptions::default() }
}

/// Options of a page's canvas: on a device, or by WebGL.
#[cfg(target_arch = "wasm32")]
pub fn page_options(with_device: bool) -> eframe::WebOptions {
    let renderer = if with_device { eframe::Renderer::Wgpu } else { eframe::Renderer::Glow };
    eframe::WebOptions { renderer, wgpu_options: device_options(), ..eframe::WebOptions::default() }
}

/// How the device of a window is opened.
fn device_options() -> WgpuConfiguration {
    WgpuConfiguration { wgpu_setup: device_setup(), ..WgpuConfiguration::default() }
}

/// How a device is opened for a studio, where another program opens it.
#[doc(hidden)]
pub fn device_setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = Backends::PRIMARY;
    // Shaders without the lines of their text, which take a tenth of the time that it takes to compile them; and indirect draws,
    // whose numbers come from shaders of ours, without passes that look at those first.
    setup.instance_descriptor.flags = InstanceFlags::empty();
    setup.device_descriptor = Arc::new(Gpu::device_descriptor);
    WgpuSetup::CreateNew(setup)
}

/// The landscape in the window.
pub(crate) struct Viewport {
    gpu: Gpu,
    window: WindowDevice,
    scenes: Scenes,
    stage: Option<Box<Stage>>,
    texture: Option<TextureId>,
    /// What was pinned to compare with, and the picture of it.
    pinned: Option<Box<Stage>>,
    pinned_texture: Option<TextureId>,
    /// The order that is being built, or was last.
    ordered: Option<(u64, u64)>,
    surface: u64,
    /// What of the next picture is not yet as the last one was.
    stale: Option<Instant>,
    drawn: Option<(Camera, usize)>,
    /// Whether nothing finer is to come.
    rests: bool,
    submitted: Option<Instant>,
    /// Which of the scales fits a picture while something moves.
    moving: usize,
    /// Seconds that the last picture took.
    seconds: f64,
    /// Seconds that a finer picture may take when all rests.
    at_rest: f64,
    error: Option<String>,
}

impl Viewport {
    /// On the device of a window, which other windows may have too, with pictures at rest that are as fine as their place,
    /// or as the device is quick.
    ///
    /// # Errors
    /// [`Error::Device`] where that was opened with too little, [`Error::Run`] where the system has no thread left.
    pub(crate) fn new(
        (window, gpu): (&WindowDevice, Option<Gpu>),
        context: &Context,
        finest: bool,
    ) -> Result<Self, Error> {
        let own = || Gpu::shared(&window.adapter, &window.device, &window.queue);
        let gpu = gpu.map_or_else(own, Ok)?;
        #[cfg(not(target_arch = "wasm32"))]
        if gpu.is_software() && !window.target_format.is_srgb() {
            context.add_plugin(Interface::new(window));
        }
        let told = context.clone();
        let scenes = Scenes::new(gpu.clone(), move || told.request_repaint())?;
        Ok(Self {
            gpu,
            window: window.clone(),
            scenes,
            stage: None,
            texture: None,
            pinned: None,
            pinned_texture: None,
            ordered: None,
            surface: 0,
            stale: None,
            drawn: None,
            rests: false,
            submitted: None,
            moving: 0,
            seconds: 0.0,
            at_rest: if finest { f64::INFINITY } else { AT_REST },
            error: None,
        })
    }

    fn ask(&mut self, order: Order) {
        if !self.scenes.ask(order) {
            self.error = Some("pictures have ended by a fault of Weald".to_owned());
        }
    }

    fn show_texture(&mut self) {
        if let Some(stage) = &self.stage {
            self.texture = Some(shown_as(&self.window, stage, self.texture));
        }
        if let Some(stage) = &self.pinned {
            self.pinned_texture = Some(shown_as(&self.window, stage, self.pinned_texture));
        }
    }
}

impl Drawing for Viewport {
    fn engine(&self) -> Engine {
        if self.gpu.is_software() { Engine::Cpu } else { Engine::DeviceElseCpu(Arc::new(self.gpu.clone())) }
    }

    fn is_software(&self) -> bool {
        self.gpu.is_software()
    }

    fn device(&self) -> String {
        let info = self.window.adapter.get_info();
        format!("{} ({})", info.name, info.backend)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn wait(&self) {
        // A device that fails says so where it is drawn on.
        let _ = self.window.device.poll(eframe::wgpu::PollType::wait_indefinitely());
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

    fn order(&mut self, shown: &Shown, looks: (&View, u64), is_live: bool) {
        let number = (shown.number, looks.1);
        if self.ordered == Some(number) {
            return;
        }
        self.ordered = Some(number);
        self.ask(Order {
            landscape: Arc::clone(&shown.landscape),
            view: looks.0.clone(),
            number,
            is_live,
            is_pinned: false,
        });
    }

    fn pin(&mut self, kept: Option<(&Shown, View)>) {
        self.pinned = None;
        if let Some((shown, view)) = kept {
            let landscape = Arc::clone(&shown.landscape);
            self.ask(Order { landscape, view, number: (shown.number, 0), is_live: false, is_pinned: true });
        }
    }

    fn take_built(&mut self) {
        while let Some((order, stage)) = self.scenes.built() {
            match stage {
                Ok(stage) if order.is_pinned => {
                    (self.pinned, self.drawn) = (Some(stage), None);
                }
                Ok(stage) => {
                    self.stage = Some(stage);
                    (self.drawn, self.surface, self.error) = (None, 0, None);
                    self.show_texture();
                }
                Err(error) => {
                    self.error = Some(error.to_string());
                    self.ordered = Some(order.number);
                }
            }
        }
    }

    fn whole(&self) -> Option<Camera> {
        self.stage.as_ref().map(|stage| stage.scene.camera())
    }

    fn middle(&self) -> Option<[f32; 3]> {
        self.stage.as_ref().map(|stage| stage.scene.middle())
    }

    fn drawn_height(&self, elevation: f64) -> Option<f32> {
        self.stage.as_ref().map(|stage| stage.scene.drawn_height(elevation))
    }

    fn follow(&mut self, surface: &Surface) -> Result<(), Error> {
        let Some(stage) = &mut self.stage else { return Ok(()) };
        if stage.number.0 != surface.shown || self.surface == surface.number {
            return Ok(());
        }
        let Some(live) = &stage.live else { return Ok(()) };
        if stage.draws_water {
            live.paint(&self.gpu, &surface.canvas)?;
        } else {
            let water = Field::filled(surface.canvas.size(), 0.0);
            live.paint(&self.gpu, &Canvas { water, ..Canvas::clone(&surface.canvas) })?;
        }
        stage.renderer.follow(&stage.scene, live)?;
        self.surface = surface.number;
        self.drawn = None;
        Ok(())
    }

    fn draw(&mut self, camera: &Camera, full: [u32; 2]) -> Result<Option<Duration>, Error> {
        let _span = tracing::trace_span!("picture").entered();
        let Some(stage) = &mut self.stage else { return Ok(None) };
        if let Some(submitted) = self.submitted {
            if stage.screen.in_flight() > 0 {
                // Asking for answers lets the device tell what is done.
                stage.screen.answers()?;
                if stage.screen.in_flight() > 0 && submitted.elapsed() < Duration::from_secs(5) {
                    return Ok(Some(Duration::from_millis(5)));
                }
            }
            self.seconds = submitted.elapsed().as_secs_f64();
            self.submitted = None;
            self.moving = adapted(self.moving, self.drawn.map_or(0, |(_, drawn)| drawn), self.seconds);
        }
        let moves = self.drawn.is_none_or(|(drawn, _)| drawn != *camera);
        if moves {
            self.stale = Some(Instant::now());
        }
        let rests = self.stale.is_none_or(|since| since.elapsed() > REST);
        // What rests becomes finer step by step.
        let next = self.drawn.map_or(self.moving, |(_, drawn)| {
            let finer = (drawn + 1).min(SCALES.len() - 1);
            if self.seconds * growth(drawn, finer) <= self.at_rest { finer } else { drawn }
        });
        let scale = if rests { next } else { self.moving };
        let is_finer = rests && self.drawn.is_some_and(|(_, drawn)| scale > drawn);
        // What was drawn last while it moved becomes sharp.
        let is_sharper = rests && !is_finer && !stage.screen.is_settled();
        self.rests = !moves && !is_finer && !is_sharper && rests;
        if !moves && !is_finer && !is_sharper {
            return Ok((!rests).then_some(REST));
        }
        let size = full.map(|side| ((side as f32 * SCALES[scale]) as u32).max(16));
        stage.renderer.resize_screen(&mut stage.screen, size)?;
        stage.renderer.draw_on(&mut stage.screen, camera)?;
        if let Some(pinned) = &mut self.pinned {
            pinned.renderer.resize_screen(&mut pinned.screen, size)?;
            // Heights of a scene count from its own lowest ground.
            let higher = pinned.scene.drawn_height(0.0) - stage.scene.drawn_height(0.0);
            let [east, north, up] = camera.eye;
            pinned.renderer.draw_on(&mut pinned.screen, &camera.at([east, north, up + higher]))?;
        }
        (self.drawn, self.submitted) = (Some((*camera, scale)), Some(Instant::now()));
        self.show_texture();
        Ok(Some(Duration::from_millis(5)))
    }

    fn is_drawn(&self, number: Option<(u64, u64)>) -> bool {
        let is_there = self.stage.as_ref().map(|stage| stage.number) == number;
        is_there && self.drawn.is_some() && self.submitted.is_none() && self.rests
    }

    fn texture(&self) -> Option<TextureId> {
        self.drawn.and(self.texture)
    }

    fn pinned_texture(&self) -> Option<TextureId> {
        self.pinned.as_ref().and(self.drawn).and(self.pinned_texture)
    }

    fn has_pinned(&self) -> bool {
        self.pinned.is_some()
    }

    fn picture(&mut self, camera: &Camera, size: [u32; 2]) -> Result<Option<Image>, Error> {
        let Some(stage) = &mut self.stage else { return Ok(None) };
        stage.renderer.resize(size)?;
        stage.renderer.render(camera).map(Some)
    }
}

/// The picture of a stage as a texture of the window, in place of an older one.
fn shown_as(window: &WindowDevice, stage: &Stage, texture: Option<TextureId>) -> TextureId {
    let (device, view) = (&window.device, stage.screen.view());
    let mut renderer = window.renderer.write();
    match texture {
        Some(id) => {
            renderer.update_egui_texture_from_wgpu_texture(device, view, FilterMode::Linear, id);
            id
        }
        None => renderer.register_native_texture(device, view, FilterMode::Linear),
    }
}

/// How many times more pixels one scale has than another.
fn growth(from: usize, to: usize) -> f64 {
    f64::from(SCALES[to] / SCALES[from]).powi(2)
}

/// The scale for pictures that follow a movement, after one of scale `drawn` took so many seconds.
fn adapted(moving: usize, drawn: usize, seconds: f64) -> usize {
    let finer = (moving + 1).min(SCALES.len() - 1);
    if drawn <= moving && seconds > 1.5 * SLICE {
        drawn.min(moving).saturating_sub(1)
    } else if drawn >= moving && seconds * growth(drawn, finer.max(drawn)) < SLICE {
        finer
    } else {
        moving
    }
}
