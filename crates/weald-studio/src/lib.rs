//! Weald's window: a recipe as cards and as text, the landscape that follows, and brushes that paint on it while water runs.
//!
//! [`open`] shows it. Everything that can be done is a [`Command`](commands::Command); the recipe is a
//! [`Document`](document::Document), of which text is what counts; a thread of its own holds the simulation
//! ([`Work`](work::Work)), and another makes scenes. The window, the simulation and the pictures share one device.

mod brushes;
mod cameras;
pub mod commands;
mod dialogs;
pub mod document;
mod drawing;
mod frame;
pub mod host;
#[cfg(not(target_arch = "wasm32"))]
mod interface;
mod looks;
mod navigation;
mod on_page;
mod options;
mod own_files;
mod panels;
mod pick;
mod presets;
mod project;
mod rays;
#[cfg(not(target_arch = "wasm32"))]
mod response;
mod scenes;
mod section;
pub mod state;
mod studio;
#[cfg(not(target_arch = "wasm32"))]
mod trace;
mod viewport;
#[cfg(not(target_arch = "wasm32"))]
mod window;
pub mod work;

pub use brushes::Tool;
pub use dialogs::{Chooser, Wanted};
pub use navigation::Mode;
pub use options::Options;
#[cfg(not(target_arch = "wasm32"))]
pub use response::{Response, response};
pub use studio::Studio;
#[cfg(not(target_arch = "wasm32"))]
pub use trace::{Trace, record};
#[doc(hidden)]
pub use viewport::device_setup;
#[cfg(target_arch = "wasm32")]
pub use viewport::page_options;
#[cfg(not(target_arch = "wasm32"))]
pub use window::open;

/// Controls of a table by themselves: the key that was turned, and its new value.
#[doc(hidden)]
pub fn controls_for_a_test(
    ui: &mut eframe::egui::Ui,
    table: &weald::recipe::source::Table,
    parameters: &[weald::recipe::parameter::Parameter],
) -> Option<(String, Option<String>)> {
    panels::controls::controls(ui, table, parameters, "test").map(|turned| (turned.key, turned.value))
}
