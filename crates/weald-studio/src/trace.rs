//! A trace of what takes time: frames of the window, tasks and slices of the simulation, scenes, pictures.
//!
//! It is a file of trace events, which <https://ui.perfetto.dev> and the tracing pages of browsers show. Where none is
//! recorded, a span costs a look at a flag.

use std::fs::File;
use std::path::Path;

use tracing_chrome::{ChromeLayerBuilder, FlushGuard};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use weald::Error;

/// A trace that is being recorded; it is written to its end when this goes.
#[must_use = "the trace ends when it is dropped"]
pub struct Trace(#[expect(dead_code, reason = "held for what it does when it is dropped")] FlushGuard);

impl std::fmt::Debug for Trace {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Trace")
    }
}

/// Records a trace into a file, for the rest of the program.
///
/// # Errors
/// [`Error::Run`] where the file cannot be made, or a trace is recorded already.
pub fn record(file: &Path) -> Result<Trace, Error> {
    let failed = |cause: &dyn std::fmt::Display| {
        Error::Run(format!("no trace can be recorded into {}: {cause}", file.display()))
    };
    let opened = File::create(file).map_err(|cause| failed(&cause))?;
    let (layer, guard) = ChromeLayerBuilder::new().writer(opened).build();
    // Other libraries have spans of their own, which say nothing of this window.
    let own = Targets::new().with_target("weald_studio", tracing::Level::TRACE);
    let recorded = tracing_subscriber::registry().with(layer.with_filter(own)).try_init();
    recorded.map_err(|cause| failed(&cause))?;
    Ok(Trace(guard))
}
