//! Submissions of a length that leaves the device free for others.
//!
//! A driver resets a device that is busy for seconds, and a desktop on the same card stutters long before. So a
//! submission is given what lately took [`AIM`], and few are on their way at once.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use weald::Error;
use wgpu::{CommandEncoder, CommandEncoderDescriptor, SubmissionIndex};

use crate::gpu::Gpu;
use crate::memory::Held;

/// Time that a submission should take: well below the tenth of a second that it may take, as passes differ.
const AIM: Duration = Duration::from_millis(40);

/// Submissions on their way at once: the device works on one while the next is made.
const IN_FLIGHT: usize = 2;

/// Bytes of the first submission: milliseconds even where software acts as the graphics card.
const FIRST_BYTES: f64 = 16e6;

/// Share of a rate that is kept where the next submission was faster; a slower one counts at once.
const KEPT: f64 = 0.7;

/// Submits work and watches how long it takes.
#[derive(Debug)]
pub(crate) struct Pace {
    seconds_per_byte: f64,
    most_moved: u64,
    flying: VecDeque<Flying>,
    /// When the device was last known to have finished something.
    finished: Instant,
}

#[derive(Debug)]
struct Flying {
    submission: SubmissionIndex,
    bytes: u64,
    submitted: Instant,
    /// Staging that the driver keeps until then.
    _staged: Option<Held>,
}

impl Pace {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        Self {
            seconds_per_byte: AIM.as_secs_f64() / FIRST_BYTES,
            most_moved: gpu.most_moved,
            flying: VecDeque::new(),
            finished: Instant::now(),
        }
    }

    /// Bytes that the next submission may move.
    pub(crate) fn allowance(&self) -> u64 {
        ((AIM.as_secs_f64() / self.seconds_per_byte) as u64).clamp(1, self.most_moved)
    }

    /// Submits what `encode` says, which moves that many bytes, when there is room for it.
    pub(crate) fn submit(
        &mut self,
        gpu: &Gpu,
        bytes: u64,
        staged: Option<Held>,
        encode: impl FnOnce(&mut CommandEncoder),
    ) -> Result<(), Error> {
        let context = &gpu.context;
        let submission = context.attempt("a submission", || {
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            encode(&mut encoder);
            Ok(context.queue.submit([encoder.finish()]))
        })?;
        self.flying.push_back(Flying { submission, bytes, submitted: Instant::now(), _staged: staged });
        while self.flying.len() > IN_FLIGHT {
            self.wait_for_oldest(gpu)?;
        }
        Ok(())
    }

    /// Waits for all that was submitted.
    pub(crate) fn drain(&mut self, gpu: &Gpu) -> Result<(), Error> {
        while !self.flying.is_empty() {
            self.wait_for_oldest(gpu)?;
        }
        Ok(())
    }

    fn wait_for_oldest(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let Some(oldest) = self.flying.pop_front() else { return Ok(()) };
        gpu.context.wait(Some(oldest.submission))?;
        let now = Instant::now();
        let began = self.finished.max(oldest.submitted);
        self.finished = now;
        self.learn(oldest.bytes, now.duration_since(began));
        Ok(())
    }

    /// A submission took that long.
    fn learn(&mut self, bytes: u64, time: Duration) {
        let measured = time.as_secs_f64() / bytes.max(1) as f64;
        self.seconds_per_byte = measured.max(KEPT * self.seconds_per_byte);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pace() -> Pace {
        Pace {
            seconds_per_byte: AIM.as_secs_f64() / FIRST_BYTES,
            most_moved: u64::MAX,
            flying: VecDeque::new(),
            finished: Instant::now(),
        }
    }

    #[test]
    fn submissions_grow_on_a_fast_device_and_shrink_at_once_on_a_slow_one() {
        let mut pace = pace();
        for _ in 0..40 {
            let bytes = pace.allowance();
            pace.learn(bytes, Duration::from_secs_f64(bytes as f64 / 1e12));
        }
        let fast = pace.allowance() as f64 / 1e12;
        assert!((0.9..1.01).contains(&(fast / AIM.as_secs_f64())), "{fast} s");
        pace.learn(1_000_000, Duration::from_millis(10));
        assert!(pace.allowance() <= 4_000_000, "what takes 10 ms for a million takes 40 for four");
    }

    #[test]
    fn a_device_ten_times_slower_than_the_first_guess_is_met_after_one_submission() {
        let mut pace = pace();
        pace.learn(FIRST_BYTES as u64, 10 * AIM);
        assert!((pace.allowance() as f64) < FIRST_BYTES / 9.9);
    }
}
