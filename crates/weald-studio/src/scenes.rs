//! Scenes on the device, made on a thread of their own where there are threads, so that the window does not wait for one.

#[cfg(target_arch = "wasm32")]
mod at_once;
#[cfg(not(target_arch = "wasm32"))]
mod on_thread;

use std::sync::Arc;

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
}

type Built = (Order, Result<Box<Stage>, Error>);

impl Stage {
    fn new(gpu: &Gpu, order: &Order) -> Result<Self, Error> {
        let Order { landscape, view, number, is_live, .. } = order;
        let scene = LitScene::new(view, landscape)?;
        let scene = if *is_live { scene.to_follow() } else { scene };
        let mut renderer = Renderer::new(gpu, &scene, RenderOptions { size: [64, 64], samples: 1 })?;
        renderer.plant(&scene, landscape)?;
        let live = is_live.then(|| Live::new(gpu, landscape.domain.size)).transpose()?;
        let screen = renderer.screen([64, 64])?;
        Ok(Self { scene, renderer, live, screen, number: *number })
    }
}
