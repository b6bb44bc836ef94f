//! The command as people call it.

mod command;
mod engine;
mod estimates;
mod fractal;
mod interruption;
mod kills;
mod memory;
mod place;
mod render;
#[cfg(target_os = "linux")]
mod synced;
#[cfg(all(feature = "studio", target_os = "linux"))]
mod window;
