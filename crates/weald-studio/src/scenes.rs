//! Scenes on the device, made on a thread of their own where there are threads, so that the window does not wait for one.

#[cfg(target_arch = "wasm32")]
mod at_once;
#[cfg(not(target_arch = "wasm32"))]
mod on_thread;

use std::sync::Arc;

use weald::edit::{Area, Canvas};
use weald::picture::{LitScene, View};
use weald::{Error, Landscape};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer, Screen};

#[cfg(target_arch = "wasm32")]
pub(crate) use at_once::Scenes;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use on_thread::Scenes;

/// A scene that is to be made.
#[derive(Clone)]
pub(crate) struct Order {
    pub(crate) landscape: Arc<Landscape>,
    pub(crate) view: View,
    /// Number of the landscape, and of the looks.
    pub(crate) number: (u64, u64),
    /// Whether it follows a simulation.
    pub(crate) is_live: bool,
    /// Whether it is kept to compare with.
    pub(crate) is_pinned: bool,
}

/// A scene on the device.
pub(crate) struct Stage {
    pub(crate) scene: LitScene,
    pub(crate) renderer: Renderer,
    pub(crate) live: Option<Live>,
    pub(crate) screen: Screen,
    pub(crate) number: (u64, u64),
    pub(crate) draws_water: bool,
}

type Built = (Order, Result<Box<Stage>, Error>);

impl Stage {
    fn new(gpu: &Gpu, order: &Order) -> Result<Self, Error> {
        let _span = tracing::trace_span!("scene").entered();
        let Order { landscape, view, number, is_live, .. } = order;
        let scene = LitScene::new(view, landscape)?;
        let scene = if *is_live { scene.to_follow() } else { scene };
        let options = RenderOptions { size: [64, 64], samples: 1 };
        let mut renderer = Renderer::planted(gpu, (&scene, landscape), options)?;
        let live = is_live.then(|| Live::new(gpu, landscape.domain.size)).transpose()?;
        let screen = renderer.screen([64, 64])?;
        let mut stage = Self { scene, renderer, live, screen, number: *number, draws_water: view.water };
        stage.show_water(gpu, landscape)?;
        Ok(stage)
    }

    /// Shows all the water of a landscape that a simulation has left, as while it ran: a view by itself shows lakes and rivers,
    /// and what was poured on a slope is neither.
    fn show_water(&mut self, gpu: &Gpu, landscape: &Landscape) -> Result<(), Error> {
        let (Some(live), true) = (&self.live, self.draws_water) else { return Ok(()) };
        let (Ok(ground), Ok(water)) = (landscape.field("height"), landscape.field("water")) else {
            return Ok(());
        };
        let domain = &landscape.domain;
        let mut canvas = Canvas::level(Area { first: [0, 0], size: domain.size }, domain.cell, &[]);
        (canvas.bedrock, canvas.water) = (ground.clone(), water.clone());
        live.paint(gpu, &canvas)?;
        self.renderer.follow(&self.scene, live)
    }
}
