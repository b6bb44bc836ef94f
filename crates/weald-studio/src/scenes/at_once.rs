//! Scenes where there is one thread: each is made when the window asks for what was made.

use std::cell::RefCell;

use weald::Error;
use weald_gpu::Gpu;

use super::{Built, Order, Stage};

/// Makes scenes.
pub(crate) struct Scenes {
    gpu: Gpu,
    orders: RefCell<Vec<Order>>,
}

impl Scenes {
    /// On a device. Nobody needs to be told when a scene is made.
    #[expect(clippy::unnecessary_wraps, reason = "as where a thread has to start")]
    pub(crate) fn new(gpu: Gpu, _: impl Fn() + Send + 'static) -> Result<Self, Error> {
        Ok(Self { gpu, orders: RefCell::default() })
    }

    /// Orders a scene, in place of what was ordered of its kind.
    pub(crate) fn ask(&self, order: Order) -> bool {
        let mut orders = self.orders.borrow_mut();
        orders.retain(|other| other.is_pinned != order.is_pinned);
        orders.push(order);
        true
    }

    /// The next scene.
    pub(crate) fn built(&self) -> Option<Built> {
        let order = self.orders.borrow_mut().pop()?;
        let stage = Stage::new(&self.gpu, &order).map(Box::new);
        Some((order, stage))
    }
}
