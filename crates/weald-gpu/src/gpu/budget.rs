//! A budget of device memory, and who holds how much of it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind, bytes_in_words};

use super::advice::Advice;

/// Least budget: below it, staging and uniforms leave no room for a program.
pub(crate) const LEAST: u64 = 1 << 20;

/// Bytes that may be held together, that are held, and that were held at most.
#[derive(Debug)]
pub(crate) struct Memory {
    budget: u64,
    held: AtomicU64,
    peak: AtomicU64,
    advice: &'static Advice,
}

impl Memory {
    /// A budget, and what to say where it is spent.
    pub(crate) fn new(budget: u64, advice: &'static Advice) -> Arc<Self> {
        Arc::new(Self { budget, held: AtomicU64::new(0), peak: AtomicU64::new(0), advice })
    }

    pub(crate) fn budget(&self) -> u64 {
        self.budget
    }

    pub(crate) fn held(&self) -> u64 {
        self.held.load(Ordering::Relaxed)
    }

    pub(crate) fn peak(&self) -> u64 {
        self.peak.load(Ordering::Relaxed)
    }

    /// Takes bytes from the budget, until what is returned is dropped.
    pub(crate) fn hold(self: &Arc<Self>, bytes: u64, what: &str) -> Result<Reservation, Error> {
        let fits = |held: u64| held.checked_add(bytes).filter(|&sum| sum <= self.budget);
        let before = self.held.fetch_update(Ordering::Relaxed, Ordering::Relaxed, fits).map_err(|held| {
            let message = format!(
                "{what} takes {} of GPU memory; {} of {} are in use; {}",
                bytes_in_words(bytes),
                bytes_in_words(held),
                bytes_in_words(self.budget),
                self.advice.spent
            );
            let (asked, free) = (Some(bytes), Some(self.budget - held));
            DeviceError::new(DeviceErrorKind::OutOfMemory { asked, free }, message)
        })?;
        self.peak.fetch_max(before + bytes, Ordering::Relaxed);
        Ok(Reservation { memory: Arc::clone(self), bytes })
    }
}

/// Bytes of a budget.
#[derive(Debug)]
pub(crate) struct Reservation {
    memory: Arc<Memory>,
    bytes: u64,
}

impl Drop for Reservation {
    fn drop(&mut self) {
        self.memory.held.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::advice::SIMULATION;

    #[test]
    fn what_is_dropped_can_be_held_again_and_the_peak_stays() {
        let memory = Memory::new(100, &SIMULATION);
        let first = memory.hold(60, "one").expect("it fits");
        assert!(memory.hold(41, "two").is_err(), "the budget would be passed");
        drop(first);
        let _second = memory.hold(41, "two").expect("it fits now");
        assert_eq!((memory.held(), memory.peak()), (41, 60));
    }

    #[test]
    fn no_number_of_bytes_overflows_the_count() {
        let memory = Memory::new(u64::MAX, &SIMULATION);
        let _some = memory.hold(10, "some").expect("it fits");
        let error = memory.hold(u64::MAX, "all").expect_err("10 are held");
        let message = error.to_string();
        assert!(message.contains("all takes") && message.contains("10 bytes of"), "{message}");
        let Error::Device(DeviceError { kind: DeviceErrorKind::OutOfMemory { asked, free }, .. }) = error
        else {
            panic!("{message}")
        };
        assert_eq!((asked, free), (Some(u64::MAX), Some(u64::MAX - 10)));
    }
}
