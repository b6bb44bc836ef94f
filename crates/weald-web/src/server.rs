//! The worker's half: tasks come as messages, and are done in turns between which the browser can bring others.

use std::sync::Arc;
use std::time::Duration;

use js_sys::Array;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};
use weald::engine::Engine;
use weald_gpu::{Gpu, Suspension};
use weald_studio::work::{Parcel, Served, Simulates};
use web_sys::DedicatedWorkerGlobalScope;

use crate::parcels::{message_of, parcel_of};

#[wasm_bindgen]
extern "C" {
    /// Suspends the program, where the worker has begun it so that it can be; the number that comes says nothing.
    #[wasm_bindgen(js_namespace = weald, js_name = suspend)]
    fn suspend_program(milliseconds: f64) -> f64;
    #[wasm_bindgen(js_namespace = weald, js_name = wake)]
    fn wake_program();
}

fn suspend(at_most: Duration) {
    suspend_program(1000.0 * at_most.as_secs_f64());
}

/// The worker of a page.
#[wasm_bindgen]
pub struct Server {
    served: Served,
}

#[wasm_bindgen]
impl Server {
    /// A worker that simulates on the processor; `why` it does where a device could be expected to.
    #[wasm_bindgen(js_name = onProcessor)]
    pub fn on_processor(why: Option<String>) -> Self {
        console_error_panic_hook::set_once();
        let simulates = Simulates { engine: Engine::Cpu, without_device: why };
        Self { served: Served::new(simulates, post) }
    }

    /// A worker that simulates on the device of that name. Its turns must be begun so that they can be suspended. Where
    /// the device fails that was `demanded`, the processor does not take its place.
    ///
    /// # Errors
    /// A sentence where there is no device, or where it cannot be opened.
    #[wasm_bindgen(js_name = onDevice)]
    pub async fn on_device(name: String, demanded: bool) -> Result<Self, JsValue> {
        console_error_panic_hook::set_once();
        let suspension = Suspension { suspend, wake: wake_program };
        let gpu = Gpu::suspending(Some(name), suspension).await.map_err(|error| error.to_string())?;
        let gpu = Arc::new(gpu);
        let engine = if demanded { Engine::Device(gpu) } else { Engine::DeviceElseCpu(gpu) };
        Ok(Self { served: Served::new(Simulates { engine, without_device: None }, post) })
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
