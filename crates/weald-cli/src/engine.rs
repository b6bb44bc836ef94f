//! Where simulations run, as a user says it.

use crate::values::EngineChoice;
use std::sync::Arc;

use weald::engine::Engine;
use weald::grid::Size;
use weald::picture::{RayMarched, RenderDevice};
use weald_gpu::Gpu;

use crate::arguments::Running;
use crate::failure::Failure;

/// An engine, and what the user should know of it.
pub(crate) struct SelectedEngine {
    pub(crate) engine: Engine,
    pub(crate) note: Option<String>,
}

impl EngineChoice {
    /// Opens it, with a budget of GPU memory in bytes.
    pub(crate) fn open(self, memory: Option<u64>) -> Result<SelectedEngine, Failure> {
        if memory.is_some() && !matches!(self, Self::Auto | Self::Gpu) {
            return Err(Failure::usage("--gpu-memory goes with --engine gpu or auto"));
        }
        let engine = match self {
            Self::Auto => return automatic(memory),
            Self::Cpu => Engine::Cpu,
            Self::Gpu => Engine::Device(Arc::new(with_memory(Gpu::any()?, memory)?)),
            Self::Bands(count) => Engine::Bands(count),
            Self::Tiles(side) => Engine::Tiles(Size::square(side)?),
        };
        Ok(SelectedEngine { engine, note: None })
    }
}

/// A card that is there and cannot be used is no reason not to run.
fn automatic(memory: Option<u64>) -> Result<SelectedEngine, Failure> {
    let (found, note) = match Gpu::hardware() {
        Ok(found) => (found, None),
        Err(error) => (None, Some(format!("{error}; running on the CPU"))),
    };
    let engine = match found {
        Some(gpu) => Engine::DeviceElseCpu(Arc::new(with_memory(gpu, memory)?)),
        None => Engine::Cpu,
    };
    Ok(SelectedEngine { engine, note })
}

/// The device that draws; the processor where it is to and there is no device.
pub(crate) fn drawing(running: &Running) -> Result<Arc<dyn RenderDevice>, Failure> {
    match Gpu::for_drawing() {
        Ok(gpu) => Ok(Arc::new(with_memory(gpu, running.gpu_memory)?)),
        Err(_) if running.fallback.is_some() => Ok(Arc::new(RayMarched)),
        Err(error) => Err(error.into()),
    }
}

/// The device with the budget that the user gave, if any.
pub(crate) fn with_memory(gpu: Gpu, memory: Option<u64>) -> Result<Gpu, weald::Error> {
    match memory {
        Some(bytes) => gpu.with_memory(bytes),
        None => Ok(gpu),
    }
}
