//! How the end of work on a device is waited for.

use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::time::Duration;

/// Time after which it is asked again whether a shared device is done.
const LOOK_AGAIN: Duration = Duration::from_micros(100);

/// Longest time that a program is suspended without a look at its device: one that is lost may wake nobody.
const SUSPENDED_AT_MOST: Duration = Duration::from_millis(250);

/// How a program is suspended that must not block, as in a browser, where a device tells nothing while the program runs.
#[derive(Clone, Copy, Debug)]
pub struct Suspension {
    /// Suspends the program until it is woken, or for so long at most.
    pub suspend: fn(Duration),
    /// Wakes it; a program that is awake is not suspended the next time.
    pub wake: fn(),
}

/// How a device is waited for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Waiting {
    /// In its driver.
    InDriver,
    /// By looking again and again: as long as one thread waits in wgpu 30, no other can present what it drew.
    Looking,
    /// By suspending the program until the device wakes it.
    Suspended(Suspension),
    /// Not at all, on a page: what is submitted is done in its order all the same.
    Never,
}

impl Waiting {
    /// Whether each submission tells that it is done.
    pub(super) fn is_told(self) -> bool {
        matches!(self, Self::Looking | Self::Suspended(_))
    }

    /// Whether the program is suspended as long as it waits.
    pub(crate) fn suspends(self) -> bool {
        matches!(self, Self::Suspended(_))
    }

    /// A call by which a device tells something, and where that arrives.
    pub(super) fn told<T: Send + 'static>(self) -> (impl FnOnce(T) + Send + 'static, Receiver<T>) {
        let (sender, told) = channel();
        let tell = move |what| {
            // Who no longer listens needs not be told.
            let _ = sender.send(what);
            if let Self::Suspended(suspension) = self {
                (suspension.wake)();
            }
        };
        (tell, told)
    }

    /// What is told within a short while.
    pub(super) fn next<T>(self, told: &Receiver<T>) -> Result<T, RecvTimeoutError> {
        let Self::Suspended(suspension) = self else { return told.recv_timeout(LOOK_AGAIN) };
        let look = || {
            told.try_recv().map_err(|cause| match cause {
                TryRecvError::Empty => RecvTimeoutError::Timeout,
                TryRecvError::Disconnected => RecvTimeoutError::Disconnected,
            })
        };
        match look() {
            Err(RecvTimeoutError::Timeout) => {
                (suspension.suspend)(SUSPENDED_AT_MOST);
                look()
            }
            known => known,
        }
    }
}
