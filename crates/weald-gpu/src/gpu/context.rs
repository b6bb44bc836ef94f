//! An open device: calls whose errors come back, and waiting for it.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use rayon::prelude::*;
use web_time::Instant;

use weald::Error;
use weald::engine::program::MAX_BUFFERS;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::{
    BindGroupLayout, CommandBuffer, ComputePipeline, DeviceDescriptor, DeviceType, Features, Limits,
    MemoryHints, SubmissionIndex,
};

use super::adapter;
use super::advice::Advice;
use super::faults::{Faults, explain};
use super::known::Known;
use super::waiting::Waiting;

/// Longest wait for a submission, which is made to take a tenth of a second: then the device hangs.
const TIMEOUT: Duration = Duration::from_mins(2);

/// The same of software, which draws a meadow in minutes and shares the processor with all else.
const TIMEOUT_OF_SOFTWARE: Duration = Duration::from_mins(20);

/// What fails where a device is lost meanwhile.
const WAITING: &str = "waiting for the GPU";

/// Memory from which the driver cuts small buffers. Small blocks waste little of a small budget.
const BLOCK_BYTES: u64 = 4 << 20;

/// What a device needs for a clock that passes can read.
pub(crate) const CLOCK: Features = Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_PASSES);

/// Pipelines and what they are bound to, by the name of their pass and the text of their module.
pub(crate) type Pipelines = HashMap<(String, String), (ComputePipeline, BindGroupLayout)>;

/// Commands that were submitted.
#[derive(Debug)]
pub(crate) struct Submitted {
    index: SubmissionIndex,
    /// Where the device says that they are done, if it does.
    done: Option<Receiver<()>>,
}

/// A device and its queue.
#[derive(Debug)]
pub(crate) struct Context {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// Adapter and driver.
    pub(crate) adapter: String,
    pub(crate) kind: DeviceType,
    pub(crate) limits: Limits,
    /// All of programs that were compiled so far.
    pub(crate) pipelines: Mutex<Pipelines>,
    /// All of pictures that were compiled so far.
    pub(crate) known: Known,
    /// What to say where it fails.
    pub(crate) advice: &'static Advice,
    faults: Arc<Faults>,
    pub(crate) waiting: Waiting,
}

impl Context {
    /// Opens a device with its largest buffers, and otherwise with what browsers grant too.
    pub(crate) async fn open(
        adapter: &wgpu::Adapter,
        waiting: Waiting,
        advice: &'static Advice,
    ) -> Result<Self, Error> {
        let name = adapter::describe(adapter);
        let (device, queue) = adapter.request_device(&description(adapter)).await.map_err(|cause| {
            let message = format!("{name} cannot be opened: {cause}; {}", advice.unopened);
            DeviceError::new(DeviceErrorKind::NotOpened, message)
        })?;
        Ok(Self::of(adapter, (device, queue), waiting, advice))
    }

    /// A device that another opened for a window, whose thread must not wait for others, unless it has less than is
    /// needed.
    pub(crate) fn shared(
        adapter: &wgpu::Adapter,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        advice: &'static Advice,
    ) -> Result<Self, Error> {
        let mut lacks = Vec::new();
        let note = |what, needed, has| lacks.push(format!("{what} is {has}, of which {needed} are needed"));
        least(&adapter.limits()).check_limits_with_fail_fn(&device.limits(), false, note);
        if lacks.is_empty() {
            let waiting = if cfg!(target_arch = "wasm32") { Waiting::Never } else { Waiting::Looking };
            return Ok(Self::of(adapter, (device.clone(), queue.clone()), waiting, advice));
        }
        let message = format!(
            "{} was opened with too little: {}; {}",
            adapter::describe(adapter),
            lacks.join(", "),
            advice.unopened
        );
        Err(DeviceError::new(DeviceErrorKind::NotOpened, message).into())
    }

    fn of(
        adapter: &wgpu::Adapter,
        (device, queue): (wgpu::Device, wgpu::Queue),
        waiting: Waiting,
        advice: &'static Advice,
    ) -> Self {
        Self {
            adapter: adapter::describe(adapter),
            kind: adapter.get_info().device_type,
            limits: device.limits(),
            pipelines: Mutex::default(),
            known: Known::default(),
            faults: Faults::of(&device),
            advice,
            waiting,
            device,
            queue,
        }
    }

    /// What went wrong since it was last asked; waits for nothing.
    pub(crate) fn check(&self, what: &str) -> Result<(), Error> {
        self.faults.check(what, self.advice)
    }

    /// Lets the device call back for what is done by now; waits for nothing.
    pub(crate) fn tend(&self, what: &str) -> Result<(), Error> {
        self.poll(wgpu::PollType::Poll);
        self.check(what)
    }

    /// Where the device is lost meanwhile, wgpu 30 panics instead of returning an error; `None` then.
    fn poll(&self, how: wgpu::PollType) -> Option<Result<wgpu::PollStatus, wgpu::PollError>> {
        let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(how))).ok();
        if polled.is_none() {
            self.faults.lose("while work was waited for");
        }
        polled
    }

    /// Does something on the device. Whatever wgpu finds wrong with it becomes an error that names `what`.
    pub(crate) fn attempt<T>(&self, what: &str, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        self.faults.check(what, self.advice)?;
        let (done, caught) = self.caught(work);
        self.faults.check(what, self.advice)?;
        match caught {
            Some(error) => Err(explain(what, &error, self.advice)),
            None => done,
        }
    }

    /// What is done, and the last error of wgpu with it.
    #[cfg(not(target_arch = "wasm32"))]
    fn caught<T>(&self, work: impl FnOnce() -> T) -> (T, Option<wgpu::Error>) {
        use wgpu::ErrorFilter;
        let filters = [ErrorFilter::OutOfMemory, ErrorFilter::Validation, ErrorFilter::Internal];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let done = work();
        (done, scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).last())
    }

    /// A browser tells of errors only after the program has returned to it: the next call hears of them.
    #[cfg(target_arch = "wasm32")]
    #[expect(clippy::unused_self, reason = "as where errors are caught")]
    fn caught<T>(&self, work: impl FnOnce() -> T) -> (T, Option<wgpu::Error>) {
        (work(), None)
    }

    /// As [`Context::attempt`], for work that makes modules and pipelines of pictures: where it fails none of them is
    /// kept, for it may be one of them that is broken.
    pub(crate) fn attempt_to_compile<T>(
        &self,
        what: &str,
        work: impl FnOnce() -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.attempt(what, work).inspect_err(|_| self.known.clear())
    }

    /// Does things side by side on the threads of this pool, within [`Context::attempt_to_compile`]: errors of wgpu go to
    /// the thread that makes them.
    pub(crate) fn side_by_side<T: Send>(
        &self,
        what: &str,
        works: &[Box<dyn Fn() -> T + Sync + '_>],
    ) -> Result<Vec<T>, Error> {
        let done = works.par_iter().map(|work| match self.caught(work) {
            (done, None) => Ok(done),
            (_, Some(error)) => Err(explain(what, &error, self.advice)),
        });
        done.collect()
    }

    /// Submits commands, for which can be waited.
    pub(crate) fn submit(&self, commands: impl IntoIterator<Item = CommandBuffer>) -> Submitted {
        let index = self.queue.submit(commands);
        let done = self.waiting.is_told().then(|| {
            let (tell, done) = self.waiting.told();
            self.queue.on_submitted_work_done(move || tell(()));
            done
        });
        Submitted { index, done }
    }

    /// Waits until a submission is done, or all of them.
    pub(crate) fn wait(&self, submission: Option<Submitted>) -> Result<(), Error> {
        self.wait_at_most(self.patience(), submission)
    }

    fn patience(&self) -> Duration {
        if self.kind == DeviceType::Cpu { TIMEOUT_OF_SOFTWARE } else { TIMEOUT }
    }

    /// As [`Context::wait`], for what may take longer than all else.
    pub(crate) fn wait_at_most(
        &self,
        patience: Duration,
        submission: Option<Submitted>,
    ) -> Result<(), Error> {
        match self.waiting {
            Waiting::Never => return self.check(WAITING),
            Waiting::Looking | Waiting::Suspended(_) => {
                let submission = submission.unwrap_or_else(|| self.submit([]));
                let Some(done) = submission.done else { return Ok(()) };
                // What was refused is never done.
                return self.look_until_told(patience, &done).map(drop);
            }
            Waiting::InDriver => {}
        }
        let submission_index = submission.map(|submission| submission.index);
        let polled = self.poll(wgpu::PollType::Wait { submission_index, timeout: Some(patience) });
        self.check(WAITING)?;
        match polled {
            // It took a submission only to refuse it: it is lost, though nobody has been told yet.
            Some(Err(wgpu::PollError::WrongSubmissionIndex(..))) => {
                self.faults.lose("it took no more work");
                self.check(WAITING)
            }
            Some(Err(cause)) => Err(self.silent(&cause.to_string())),
            _ => Ok(()),
        }
    }

    /// Asks the device for what it tells by a call, and waits for that; `None` where it will never tell.
    pub(crate) fn answer<T: Send + 'static>(
        &self,
        ask: impl FnOnce(Box<dyn FnOnce(T) + Send>),
    ) -> Result<Option<T>, Error> {
        let (tell, told) = self.waiting.told();
        ask(Box::new(tell));
        if self.waiting.suspends() {
            return self.look_until_told(self.patience(), &told);
        }
        self.wait(None)?;
        Ok(told.recv().ok())
    }

    /// Waits for what is told, by looking again and again; `None` where it never will be.
    fn look_until_told<T>(&self, patience: Duration, told: &Receiver<T>) -> Result<Option<T>, Error> {
        let begun = Instant::now();
        while begun.elapsed() < patience {
            self.tend(WAITING)?;
            match self.waiting.next(told) {
                Err(RecvTimeoutError::Timeout) => {}
                known => return self.check(WAITING).map(|()| known.ok()),
            }
        }
        Err(self.silent("it did not finish in time"))
    }

    fn silent(&self, cause: &str) -> Error {
        let message = format!("the GPU does not answer: {cause}; {}", self.advice.silent);
        DeviceError::new(DeviceErrorKind::Unresponsive, message).into()
    }
}

/// What is asked of a device.
pub(crate) fn description(adapter: &wgpu::Adapter) -> DeviceDescriptor<'static> {
    DeviceDescriptor {
        label: Some("weald"),
        // Clocks of passes, where there are some, are for benches.
        required_features: adapter.features() & CLOCK,
        required_limits: limits(&adapter.limits()),
        memory_hints: MemoryHints::Manual { suballocated_device_memory_block_size: BLOCK_BYTES..BLOCK_BYTES },
        ..DeviceDescriptor::default()
    }
}

/// The least that programs and pictures need, where a device of such limits has it.
fn least(offered: &Limits) -> Limits {
    Limits {
        max_storage_buffers_per_shader_stage: MAX_BUFFERS as u32,
        ..Limits::defaults().or_worse_values_from(offered)
    }
}

/// That, with the largest buffers there are.
fn limits(offered: &Limits) -> Limits {
    Limits {
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..least(offered)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_buffers_that_a_device_offers_are_asked_for_and_no_more_than_it_has() {
        let offered = Limits {
            max_buffer_size: 1 << 40,
            max_storage_buffer_binding_size: 1 << 33,
            ..Limits::default()
        };
        let asked = limits(&offered);
        assert_eq!((asked.max_buffer_size, asked.max_storage_buffer_binding_size), (1 << 40, 1 << 33));
        assert_eq!(asked.max_storage_buffers_per_shader_stage, MAX_BUFFERS as u32);
        let small = Limits { max_texture_dimension_2d: 64, ..Limits::default() };
        assert_eq!(limits(&small).max_texture_dimension_2d, 64);
    }
}
