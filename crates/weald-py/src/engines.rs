//! Where simulations run, as a caller says it: the words are those of the command.

use std::sync::Arc;

use weald::Size;

use pyo3::prelude::*;

use crate::watch::{Caller, Line};
use weald::engine::Engine;
use weald::error::Error;
use weald::picture::{RayMarched, RenderDevice};

/// The name of an engine.
pub(crate) struct EngineName(String);

/// How something is run, as the keywords of a call say it.
pub(crate) struct Call {
    pub(crate) engine: EngineName,
    pub(crate) caller: Caller,
}

impl FromPyObject<'_, '_> for Call {
    type Error = PyErr;

    fn extract(call: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let (engine, threads, callback) = call.extract()?;
        Ok(Self { engine: EngineName(engine), caller: Caller { callback, threads } })
    }
}

impl EngineName {
    /// Opens the engine, and tells the caller what is to be known of it.
    pub(crate) fn open(&self, line: &Line) -> Result<Engine, Error> {
        let (engine, note) = engine(&self.0)?;
        if let Some(note) = note {
            line.say(&note);
        }
        Ok(engine)
    }
}

/// The engine of that name, and what the user should know of it.
fn engine(name: &str) -> Result<(Engine, Option<String>), Error> {
    let count = |prefix: &str| name.strip_prefix(prefix).and_then(|count| count.parse::<usize>().ok());
    let engine = match (name, count("bands:"), count("tiles:")) {
        ("auto", ..) => return Ok(automatic()),
        ("cpu", ..) => Engine::Cpu,
        ("gpu", ..) => gpu()?,
        (_, Some(bands @ 1..=1024), _) => Engine::Bands(bands),
        (_, _, Some(side @ 1..=65_536)) => Engine::Tiles(Size::square(side)?),
        _ => {
            let message =
                format!("there is no engine `{name}`; the engines are \"auto\", \"cpu\" and \"gpu\"");
            return Err(Error::Run(message));
        }
    };
    Ok((engine, None))
}

#[cfg(feature = "gpu")]
fn gpu() -> Result<Engine, Error> {
    Ok(Engine::Device(Arc::new(weald_gpu::Gpu::any()?)))
}

#[cfg(not(feature = "gpu"))]
fn gpu() -> Result<Engine, Error> {
    Err(Error::Run(weald::error::left_out("the engine `gpu`", "gpu")))
}

/// A card that is there and cannot be used is no reason not to run.
#[cfg(feature = "gpu")]
fn automatic() -> (Engine, Option<String>) {
    match weald_gpu::Gpu::hardware() {
        Ok(Some(gpu)) => (Engine::DeviceElseCpu(Arc::new(gpu)), None),
        Ok(None) => (Engine::Cpu, None),
        Err(error) => (Engine::Cpu, Some(format!("{error}; running on the CPU"))),
    }
}

#[cfg(not(feature = "gpu"))]
fn automatic() -> (Engine, Option<String>) {
    (Engine::Cpu, None)
}

/// What draws pictures of kind `render`: a device, or the processor where there is none.
pub(crate) fn drawing() -> Arc<dyn RenderDevice> {
    #[cfg(feature = "gpu")]
    if let Ok(gpu) = weald_gpu::Gpu::for_drawing() {
        return Arc::new(gpu);
    }
    Arc::new(RayMarched)
}
