//! Scenes on the device, made on a thread of their own, so that the window never waits for one.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use weald::picture::{LitScene, View};
use weald::{Error, Landscape};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer, Screen};

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

/// The thread that makes scenes.
pub(crate) struct Scenes {
    orders: Sender<Order>,
    built: Receiver<Built>,
}

impl Scenes {
    /// A thread that calls `tell` when a scene is made.
    pub(crate) fn new(gpu: Gpu, tell: impl Fn() + Send + 'static) -> Result<Self, Error> {
        let (orders, received) = channel::<Order>();
        let (sender, built) = channel();
        let build = move || {
            while let Ok(order) = received.recv() {
                for order in without_superseded(order, &received) {
                    let stage = Stage::new(&gpu, &order).map(Box::new);
                    if sender.send((order, stage)).is_err() {
                        return;
                    }
                    tell();
                }
            }
        };
        let thread = std::thread::Builder::new().name("weald-scenes".to_owned()).spawn(build);
        thread.map_err(|cause| Error::Run(format!("no thread for pictures: {cause}")))?;
        Ok(Self { orders, built })
    }

    /// Orders a scene; `false` where the thread has ended.
    pub(crate) fn ask(&self, order: Order) -> bool {
        self.orders.send(order).is_ok()
    }

    /// A scene that was made meanwhile.
    pub(crate) fn built(&self) -> Option<Built> {
        self.built.try_recv().ok()
    }
}

/// Of what was ordered meanwhile, the last one of each kind: only that counts.
fn without_superseded(first: Order, received: &Receiver<Order>) -> Vec<Order> {
    let (mut shown, mut pinned) = (None, None);
    for order in std::iter::once(first).chain(received.try_iter()) {
        if order.is_pinned { pinned = Some(order) } else { shown = Some(order) }
    }
    [shown, pinned].into_iter().flatten().collect()
}

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
