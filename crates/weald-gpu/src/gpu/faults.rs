//! What goes wrong on a device between or behind calls, kept until a call can say it.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use weald::Error;

use super::advice::Advice;

/// Faults of a device so far.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    lost: OnceLock<String>,
    uncaught: Mutex<Option<String>>,
}

impl Faults {
    /// Listens to a device. Without a listener wgpu panics.
    pub(crate) fn of(device: &wgpu::Device) -> Arc<Self> {
        let faults = Arc::new(Self::default());
        let listener = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            let message = if message.is_empty() { format!("{reason:?}") } else { message };
            listener.lose(&message);
        });
        let listener = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut uncaught = listener.uncaught.lock().unwrap_or_else(PoisonError::into_inner);
            uncaught.get_or_insert_with(|| error.to_string());
        }));
        faults
    }

    /// The device is gone; only the first reason counts.
    pub(crate) fn lose(&self, reason: &str) {
        let _ = self.lost.set(reason.trim().to_owned());
    }

    /// An error where the device is lost, or where something failed that no call has spoken of yet.
    pub(crate) fn check(&self, what: &str, advice: &Advice) -> Result<(), Error> {
        if let Some(reason) = self.lost.get() {
            return Err(Error::Device(format!(
                "the GPU was lost ({reason}), so {what} failed; {}",
                advice.lost
            )));
        }
        let uncaught = self.uncaught.lock().unwrap_or_else(PoisonError::into_inner).take();
        uncaught.map_or(Ok(()), |message| Err(Error::Device(format!("{what} failed on the GPU: {message}"))))
    }
}

/// An error of wgpu, in our words.
pub(crate) fn explain(what: &str, error: &wgpu::Error, advice: &Advice) -> Error {
    Error::Device(match error {
        wgpu::Error::OutOfMemory { .. } => {
            format!("{what} failed: the GPU's memory is full; {}", advice.full)
        }
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
            format!("{what} failed on the GPU: {description}")
        }
    })
}
