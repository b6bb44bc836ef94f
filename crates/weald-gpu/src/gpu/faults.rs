//! What goes wrong on a device between or behind calls, kept until a call can say it.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind};

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
            let message = format!("the GPU was lost ({reason}), so {what} failed; {}", advice.lost);
            return Err(DeviceError::new(DeviceErrorKind::Lost { reason: reason.clone() }, message).into());
        }
        let uncaught = self.uncaught.lock().unwrap_or_else(PoisonError::into_inner).take();
        uncaught.map_or(Ok(()), |message| Err(failed(what, &message)))
    }
}

/// An error of wgpu, in our words.
pub(crate) fn explain(what: &str, error: &wgpu::Error, advice: &Advice) -> Error {
    match error {
        wgpu::Error::OutOfMemory { .. } => {
            let kind = DeviceErrorKind::OutOfMemory { asked: None, free: None };
            let message = format!("{what} failed: the GPU's memory is full; {}", advice.full);
            DeviceError::new(kind, message).into()
        }
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
            failed(what, description)
        }
    }
}

fn failed(what: &str, why: &str) -> Error {
    DeviceError::new(DeviceErrorKind::Failed, format!("{what} failed on the GPU: {why}")).into()
}
