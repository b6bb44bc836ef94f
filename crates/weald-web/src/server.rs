//! The worker's half: tasks come as messages, and are done in turns between which the browser can bring others.

use js_sys::Array;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};
use weald::engine::Engine;
use weald_studio::work::{Parcel, Served};
use web_sys::DedicatedWorkerGlobalScope;

use crate::parcels::{message_of, parcel_of};

/// The worker of a page.
#[wasm_bindgen]
pub struct Server {
    served: Served,
}

#[wasm_bindgen]
impl Server {
    /// A worker that simulates on the processor.
    #[wasm_bindgen(constructor)]
    #[expect(clippy::new_without_default, reason = "made by JavaScript alone")]
    pub fn new() -> Self {
        console_error_panic_hook::set_once();
        Self { served: Served::new(Engine::Cpu, post) }
    }

    /// Takes a message of the page.
    ///
    /// # Errors
    /// A sentence for one that cannot be read.
    pub fn take(&mut self, text: String, arrays: &Array) -> Result<(), JsValue> {
        self.served.take(parcel_of(text, arrays)).map_err(|error| error.to_string().into())
    }

    /// Works for a turn, and gives how many milliseconds there is nothing to do; -1 for ever.
    pub fn turn(&mut self) -> f64 {
        self.served.turn().map_or(-1.0, |rest| 1000.0 * rest.as_secs_f64())
    }

    /// How many milliseconds there is nothing to do; -1 for ever.
    pub fn rest(&self) -> f64 {
        self.served.rest().map_or(-1.0, |rest| 1000.0 * rest.as_secs_f64())
    }
}

/// Sends a message to the page.
fn post(parcel: Parcel) {
    let (message, memory) = message_of(parcel);
    let scope: DedicatedWorkerGlobalScope = js_sys::global().unchecked_into();
    // A page that is closed takes no more messages.
    let _ = scope.post_message_with_transfer(&message, &memory);
}
