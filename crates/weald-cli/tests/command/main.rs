//! The command as people call it.

mod command;
mod engine;
mod fractal;
mod interruption;
mod kills;
mod place;
mod render;
