//! An open device: calls whose errors come back, and waiting for it.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use weald::Error;
use weald::engine::program::MAX_BUFFERS;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::{
    BindGroupLayout, ComputePipeline, DeviceDescriptor, DeviceType, ErrorFilter, Features, Limits,
    MemoryHints, SubmissionIndex,
};

use super::adapter;
use super::advice::Advice;
use super::faults::{Faults, explain};
use super::known::Known;

/// Longest wait for a submission, which is made to take a tenth of a second: then the device hangs.
const TIMEOUT: Duration = Duration::from_mins(2);

/// Memory from which the driver cuts small buffers. Small blocks waste little of a small budget.
const BLOCK_BYTES: u64 = 4 << 20;

/// What a device needs for a clock that passes can read.
pub(crate) const CLOCK: Features = Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_PASSES);

/// Pipelines and what they are bound to, by the name of their pass and the text of their module.
pub(crate) type Pipelines = HashMap<(String, String), (ComputePipeline, BindGroupLayout)>;

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
}

impl Context {
    /// Opens a device with its largest buffers, and otherwise with what browsers grant too.
    pub(crate) fn open(adapter: &wgpu::Adapter, advice: &'static Advice) -> Result<Self, Error> {
        let name = adapter::describe(adapter);
        let limits = limits(&adapter.limits());
        let description = DeviceDescriptor {
            // Clocks of passes, where there are some, are for benches.
            required_features: adapter.features() & CLOCK,
            required_limits: limits.clone(),
            memory_hints: MemoryHints::Manual {
                suballocated_device_memory_block_size: BLOCK_BYTES..BLOCK_BYTES,
            },
            ..DeviceDescriptor::default()
        };
        let opened = pollster::block_on(adapter.request_device(&description));
        let (device, queue) = opened.map_err(|cause| {
            let message = format!("{name} cannot be opened: {cause}; {}", advice.unopened);
            DeviceError::new(DeviceErrorKind::NotOpened, message)
        })?;
        let (faults, kind) = (Faults::of(&device), adapter.get_info().device_type);
        let known = Known::default();
        Ok(Self {
            device,
            queue,
            adapter: name,
            kind,
            limits,
            pipelines: Mutex::default(),
            known,
            advice,
            faults,
        })
    }

    /// Does something on the device. Whatever wgpu finds wrong with it becomes an error that names `what`.
    pub(crate) fn attempt<T>(&self, what: &str, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        self.faults.check(what, self.advice)?;
        let filters = [ErrorFilter::OutOfMemory, ErrorFilter::Validation, ErrorFilter::Internal];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let done = work();
        let caught = scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).last();
        self.faults.check(what, self.advice)?;
        match caught {
            Some(error) => Err(explain(what, &error, self.advice)),
            None => done,
        }
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

    /// Waits until a submission is done, or all of them.
    pub(crate) fn wait(&self, submission: Option<SubmissionIndex>) -> Result<(), Error> {
        self.wait_at_most(TIMEOUT, submission)
    }

    /// As [`Context::wait`], for what may take longer than all else.
    pub(crate) fn wait_at_most(
        &self,
        patience: Duration,
        submission: Option<SubmissionIndex>,
    ) -> Result<(), Error> {
        let wait = wgpu::PollType::Wait { submission_index: submission, timeout: Some(patience) };
        // Where the device is lost during the wait, wgpu 30 panics instead of returning an error.
        let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(wait)));
        if polled.is_err() {
            self.faults.lose("while work was waited for");
        }
        self.faults.check("waiting for the GPU", self.advice)?;
        match polled {
            Ok(Err(cause)) => {
                let message = format!("the GPU does not answer: {cause}; {}", self.advice.silent);
                Err(DeviceError::new(DeviceErrorKind::Unresponsive, message).into())
            }
            _ => Ok(()),
        }
    }
}

/// What is asked of a device: the least that programs need, and the largest buffers there are.
fn limits(offered: &Limits) -> Limits {
    Limits {
        max_storage_buffers_per_shader_stage: MAX_BUFFERS as u32,
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..Limits::defaults().or_worse_values_from(offered)
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
