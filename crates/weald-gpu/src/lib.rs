//! Runs Weald's processes on a graphics card: Vulkan, Metal or Direct3D 12, by wgpu.
//!
//! A [`Gpu`] is a [`weald::engine::device::Device`]. The library hands it programs that are data; here they
//! become buffers, pipelines and submissions. State stays on the device until it is asked for. Every error is
//! [`weald::Error::Device`] with its kind ([`weald::error::DeviceErrorKind`]): no adapter, memory full, device lost; a
//! fault of the device never panics.
//!
//! ```no_run
//! # fn main() -> Result<(), weald::Error> {
//! use weald::engine::Engine;
//! use weald_gpu::Gpu;
//!
//! // As `weald run --engine auto`: a graphics card, and the CPU where there is none or it fails.
//! let engine = match Gpu::hardware()? {
//!     Some(gpu) => Engine::DeviceElseCpu(std::sync::Arc::new(gpu)),
//!     None => Engine::Cpu,
//! };
//! # Ok(())
//! # }
//! ```
//!
//! A [`Renderer`] draws a landscape, offscreen or into a window.
//!
//! A [`PointCloud`] is the points of a fractal on a device, [`SwayingPoints`] those of a plant that sways in the wind.
//! [`grow_blades`] grows grass there, [`bend_limbs`] bends plants.

mod bandwidth;
mod compiled;
mod device;
mod gpu;
mod live;
mod memory;
mod pace;
mod point_clouds;
mod program;
mod render;
mod slots;
mod transfer;

pub use gpu::{Gpu, Suspension};
pub use live::Live;
pub use point_clouds::{PointCloud, PointRates, Swayed, SwayingPoints, bend_limbs, grow_blades};
#[doc(hidden)]
pub use render::TestLook;
pub use render::{
    Chosen, GrassLook, Options as RenderOptions, Pick, PickedGround, Renderer, SceneUpdate, Screen, Timings,
    bench,
};
