//! Weald's studio in a browser. `page/` has the page: HTML and the little JavaScript that a browser needs to begin;
//! `weald-dev web` makes the folder of them that a web server serves.
//!
//! One module is loaded by the page, which shows the studio (`Page`), and by a worker, which runs recipes and simulations
//! (`Server`). Both have files in memory; the page keeps those below `/home` in the browser's storage.

#[cfg(target_arch = "wasm32")]
mod labels;
#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(target_arch = "wasm32")]
mod parcels;
#[cfg(target_arch = "wasm32")]
mod server;

#[cfg(target_arch = "wasm32")]
pub use page::{Page, all_changed, restore};
#[cfg(target_arch = "wasm32")]
pub use server::Server;
