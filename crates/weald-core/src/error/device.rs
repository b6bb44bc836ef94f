//! Errors of compute and graphics devices, in words that need no graphics interface.

use std::fmt::Display;
use std::ops::RangeInclusive;

use super::limit::Quantity;

/// A device failed, or cannot do what it was asked to.
///
/// ```
/// use weald_core::error::{DeviceError, DeviceErrorKind, Error};
///
/// /// Whether a smaller grid may do.
/// fn is_too_large(error: &Error) -> bool {
///     use DeviceErrorKind::{OutOfMemory, OverLimit};
///     matches!(error, Error::Device(DeviceError { kind: OutOfMemory { .. } | OverLimit { .. }, .. }))
/// }
/// let full = DeviceErrorKind::OutOfMemory { asked: Some(3 << 20), free: Some(1 << 20) };
/// assert!(is_too_large(&DeviceError::new(full, "3 MiB of GPU memory; 1 MiB is free").into()));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
#[non_exhaustive]
pub struct DeviceError {
    /// What a program may act on.
    pub kind: DeviceErrorKind,
    /// What the user should know: what failed, why, and what to do.
    pub message: String,
}

/// What failed on a device.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum DeviceErrorKind {
    /// There is no device of the kind that is wanted.
    NoAdapter {
        /// Devices that are there, with their drivers.
        found: Vec<String>,
    },
    /// There is one, but it cannot be opened.
    NotOpened,
    /// Its memory is full, or the share of it that may be taken.
    OutOfMemory {
        /// Bytes that were asked for, where they are known.
        asked: Option<u64>,
        /// Bytes that were left, where they are known.
        free: Option<u64>,
    },
    /// One thing alone is larger than the device allows, however much memory is free.
    OverLimit {
        /// What is counted, and in which unit.
        what: Quantity,
        /// How much was asked for.
        asked: u64,
        /// From the least to the most that is allowed.
        allowed: RangeInclusive<u64>,
    },
    /// It is gone: unplugged, reset, or taken by its driver. All further calls fail.
    Lost {
        /// What its driver says.
        reason: String,
    },
    /// It does not answer in time.
    Unresponsive,
    /// It has no such feature.
    Unsupported {
        /// The feature.
        feature: &'static str,
    },
    /// It was called with what does not fit the program that it holds, or with a program that no device can run.
    Misused,
    /// It failed in another way, which the message describes.
    Failed,
}

impl DeviceError {
    /// An error with the sentence for the user.
    pub fn new(kind: DeviceErrorKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// Names what was to be done on the device, before what was said so far.
    #[must_use]
    pub fn of(self, what: impl Display) -> Self {
        Self { message: format!("{what}: {}", self.message), ..self }
    }
}
