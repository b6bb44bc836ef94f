//! Scenes are made on a thread of their own.

use std::sync::mpsc::{Receiver, Sender, channel};

use weald::Error;
use weald_gpu::Gpu;

use super::{Built, Order, Stage};

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
