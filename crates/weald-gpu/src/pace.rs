//! Submissions of a length that leaves the device free for others.
//!
//! A driver resets a device that is busy for seconds, and a desktop on the same card stutters long before. So a
//! submission is given what lately took [`TARGET_TIME`], and few are on their way at once.

use std::collections::VecDeque;
use std::time::Duration;
use web_time::Instant;

use weald::Error;
use wgpu::{CommandEncoder, CommandEncoderDescriptor};

use crate::gpu::Gpu;
use crate::gpu::budget::Reservation;
use crate::gpu::context::Submitted;

/// Time that a submission should take: well below the tenth of a second that it may take, as passes differ.
const TARGET_TIME: Duration = Duration::from_millis(40);

/// Submissions on their way at once: the device works on one while the next is made.
const IN_FLIGHT: usize = 2;

/// Bytes of the first submission: milliseconds even where software acts as the graphics card.
const FIRST_BYTES: f64 = 16e6;

/// Share of a rate that is kept where the next submission was faster; a slower one counts at once.
const DECAY: f64 = 0.7;

/// A wait shorter than this was for something already done.
const NEGLIGIBLE_WAIT: Duration = Duration::from_micros(20);

/// Work whose rates have nothing to do with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WorkKind {
    /// Passes of the program.
    Passes,
    /// Copies of buffers and zeros.
    Copies,
    /// Looks for values that are no numbers.
    Looks,
}

/// What a submission is.
#[derive(Debug)]
pub(crate) struct Load {
    pub(crate) sort: WorkKind,
    /// Bytes that it moves.
    pub(crate) bytes: u64,
    /// Staging that the driver keeps until it is done.
    pub(crate) staged: Option<Reservation>,
}

/// Submits work and watches how long it takes.
#[derive(Debug)]
pub(crate) struct Pace {
    /// Seconds a byte of each sort.
    costs: [f64; 3],
    most_moved: u64,
    flying: VecDeque<InFlight>,
    /// When the last submission was done, where it was waited for.
    done: Option<Instant>,
}

#[derive(Debug)]
struct InFlight {
    submission: Submitted,
    submitted: Instant,
    load: Load,
}

impl Pace {
    /// A pace that knows nothing yet, with a bound on the bytes of a submission.
    pub(crate) fn new(most_moved: u64) -> Self {
        let costs = [TARGET_TIME.as_secs_f64() / FIRST_BYTES; 3];
        Self { costs, most_moved, flying: VecDeque::new(), done: None }
    }

    /// Bytes that the next submission may move.
    pub(crate) fn allowance(&self, sort: WorkKind) -> u64 {
        ((TARGET_TIME.as_secs_f64() / self.costs[sort as usize]) as u64).clamp(1, self.most_moved)
    }

    /// Submits what `encode` says, and waits until no more than a few submissions are on their way.
    pub(crate) fn submit(
        &mut self,
        gpu: &Gpu,
        load: Load,
        encode: impl FnOnce(&mut CommandEncoder),
    ) -> Result<(), Error> {
        let context = &gpu.context;
        let submission = context.attempt("a submission", || {
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            encode(&mut encoder);
            Ok(context.submit([encoder.finish()]))
        })?;
        self.flying.push_back(InFlight { submission, submitted: Instant::now(), load });
        while self.flying.len() > IN_FLIGHT {
            self.wait_for_oldest(gpu)?;
        }
        Ok(())
    }

    /// Waits for all that was submitted. A program that would be suspended for it waits for results alone: the queue keeps
    /// their order, and a browser looks after what it stages.
    pub(crate) fn drain(&mut self, gpu: &Gpu) -> Result<(), Error> {
        if gpu.context.waiting.suspends() {
            return gpu.context.check("work that was submitted");
        }
        while !self.flying.is_empty() {
            self.wait_for_oldest(gpu)?;
        }
        Ok(())
    }

    fn wait_for_oldest(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let Some(InFlight { submission, submitted, load }) = self.flying.pop_front() else { return Ok(()) };
        let asked = Instant::now();
        gpu.context.wait(Some(submission))?;
        let now = Instant::now();
        let began = self.done.map_or(submitted, |done| done.max(submitted));
        self.done = (now - asked > NEGLIGIBLE_WAIT).then_some(now);
        self.learn(&load, now - began, self.done.is_some());
        drop(load.staged);
        Ok(())
    }

    /// A submission took that long, or less where it was not waited for: that tells of a faster device, never
    /// of a slower one.
    fn learn(&mut self, load: &Load, time: Duration, waited: bool) {
        let cost = &mut self.costs[load.sort as usize];
        let measured = time.as_secs_f64() / load.bytes.max(1) as f64;
        if waited || measured < *cost {
            *cost = measured.max(DECAY * *cost);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn learn(pace: &mut Pace, bytes: u64, seconds: f64, waited: bool) {
        let load = Load { sort: WorkKind::Passes, bytes, staged: None };
        pace.learn(&load, Duration::from_secs_f64(seconds), waited);
    }

    #[test]
    fn submissions_grow_on_a_fast_device_and_shrink_at_once_on_a_slow_one() {
        let mut pace = Pace::new(u64::MAX);
        for _ in 0..40 {
            let bytes = pace.allowance(WorkKind::Passes);
            learn(&mut pace, bytes, bytes as f64 / 1e12, false);
        }
        let fast = pace.allowance(WorkKind::Passes) as f64 / 1e12;
        assert!((0.9..1.01).contains(&(fast / TARGET_TIME.as_secs_f64())), "{fast} s");
        learn(&mut pace, 1_000_000, 0.01, true);
        assert!(
            pace.allowance(WorkKind::Passes) <= 4_000_000,
            "what takes 10 ms for a million takes 40 for four"
        );
    }

    #[test]
    fn what_was_done_before_anyone_asked_says_nothing_of_a_slow_device() {
        let mut pace = Pace::new(u64::MAX);
        let before = pace.allowance(WorkKind::Passes);
        learn(&mut pace, before, 10.0, false);
        assert_eq!(pace.allowance(WorkKind::Passes), before);
    }

    #[test]
    fn fast_copies_do_not_lengthen_submissions_of_passes() {
        let mut pace = Pace::new(u64::MAX);
        let before = pace.allowance(WorkKind::Passes);
        let load = Load { sort: WorkKind::Copies, bytes: 1 << 20, staged: None };
        (0..20).for_each(|_| pace.learn(&load, Duration::from_micros(1), true));
        assert!(pace.allowance(WorkKind::Copies) > 100 * before);
        assert_eq!(pace.allowance(WorkKind::Passes), before);
    }
}
