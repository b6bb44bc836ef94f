//! An open device with a budget of its memory: what all else here works with.

use std::fmt::Debug;
use std::sync::Arc;

use weald::Error;
use weald::engine::device::ShownGround;
use weald::error::{DeviceError, DeviceErrorKind, bytes_in_words};
use weald::grid::Size;
use wgpu::{Buffer, DeviceType};

use super::adapter::{self, Wanted};
use super::advice::{Advice, DRAWING, PAGE, SIMULATION, WINDOW};
use super::budget::{self, Memory};
use super::context::{self, Context};
use super::waiting::{Suspension, Waiting};

/// Budget of a card with memory of its own. Drivers do not tell wgpu how much there is; cards with less are
/// rare.
const MEMORY_OF_A_CARD: u64 = 4 << 30;

/// Budget where the memory is the machine's own and others need it too.
const MEMORY_SHARED: u64 = 2 << 30;

/// What a program holds now: buffers, and how many values or planes they have a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown<'a> {
    pub(crate) base: &'a Buffer,
    pub(crate) added: (&'a Buffer, u32),
    pub(crate) water: Option<(&'a Buffer, u32)>,
    pub(crate) mask: Option<(&'a Buffer, u32)>,
}

/// Shows ground and water of programs as they run.
pub(crate) trait Shows: Debug + Send + Sync {
    /// Begins with the ground of a simulation.
    fn begin(&self, gpu: &Gpu, ground: &ShownGround<'_>) -> Result<(), Error>;

    /// Takes what a program of such a size holds.
    fn take(&self, gpu: &Gpu, size: Size, shown: &Shown<'_>) -> Result<(), Error>;
}

/// A compute device and a budget of its memory. Clones share both.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(crate) context: Arc<Context>,
    pub(crate) memory: Arc<Memory>,
    /// Bytes that one submission may move at most, where tests set a bound.
    pub(crate) most_moved: u64,
    /// Where ground and water of running programs are shown.
    pub(crate) shows: Option<Arc<dyn Shows>>,
}

impl Gpu {
    /// The best graphics card of this machine, `None` where there is none; never software that acts as one.
    ///
    /// # Errors
    /// [`Error::Device`] where a card is there and cannot be opened.
    pub fn hardware() -> Result<Option<Self>, Error> {
        if !adapter::may_have_a_card() {
            return Ok(None);
        }
        adapter::best(adapter::all(), Wanted::Hardware)
            .map(|adapter| Self::open(&adapter, &SIMULATION))
            .transpose()
    }

    /// The best graphics card, or software that acts as one where there is none.
    ///
    /// # Errors
    /// [`Error::Device`] where there is neither, or where it cannot be opened.
    pub fn any() -> Result<Self, Error> {
        Self::wanted(Wanted::Any)
    }

    /// As [`Gpu::any`] for drawing, whose errors say what helps to draw, and what draws without a device.
    ///
    /// # Errors
    /// As [`Gpu::any`].
    pub fn for_drawing() -> Result<Self, Error> {
        let adapters = adapter::all();
        match adapter::best(adapters, Wanted::Any) {
            Some(adapter) => Self::open(&adapter, &DRAWING),
            None => Err(adapter::none_that_draws()),
        }
    }

    /// Software that acts as a graphics card: slow, and the same on every machine.
    ///
    /// # Errors
    /// [`Error::Device`] where there is none, or where it cannot be opened.
    pub fn software() -> Result<Self, Error> {
        Self::wanted(Wanted::Software)
    }

    fn wanted(wanted: Wanted) -> Result<Self, Error> {
        let adapters = adapter::all();
        let found: Vec<_> = adapters.iter().map(adapter::describe).collect();
        let adapter = adapter::best(adapters, wanted).ok_or_else(|| adapter::none(found, wanted))?;
        Self::open(&adapter, &SIMULATION)
    }

    /// What a window asks of an adapter, so that simulations and pictures can use its device: limits, features, and how
    /// memory is cut. A window may ask for more.
    pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
        context::description(adapter)
    }

    /// The device of a window, opened as [`Gpu::device_descriptor`] says, for its simulations and pictures too: all that it
    /// says goes wrong, whoever did it, becomes an error of the next call here. Make one, and clone it: the last that was
    /// made of a device is the one that listens to it.
    ///
    /// # Errors
    /// [`Error::Device`] for a device that was opened with less.
    pub fn shared(
        adapter: &wgpu::Adapter,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Self, Error> {
        Ok(Self::of(Context::shared(adapter, (device, queue), &WINDOW)?, &WINDOW))
    }

    /// The device of a program that must not block, as the worker of a page: wherever it waits for the device it is
    /// suspended. `name` is that of the adapter where the browser tells it to scripts alone.
    ///
    /// # Errors
    /// [`Error::Device`] where there is none, or where it cannot be opened.
    pub async fn suspending(name: Option<String>, suspension: Suspension) -> Result<Self, Error> {
        let adapter = adapter::best(adapter::offered().await, Wanted::Any);
        let adapter = adapter.ok_or_else(adapter::none_in_a_browser)?;
        let mut context = Context::open(&adapter, Waiting::Suspended(suspension), &PAGE).await?;
        if let Some(name) = name {
            context.adapter = name;
        }
        Ok(Self::of(context, &PAGE))
    }

    fn open(adapter: &wgpu::Adapter, advice: &'static Advice) -> Result<Self, Error> {
        let opened = pollster::block_on(Context::open(adapter, Waiting::InDriver, advice));
        Ok(Self::of(opened?, advice))
    }

    fn of(context: Context, advice: &'static Advice) -> Self {
        let context = Arc::new(context);
        let budget = match context.kind {
            DeviceType::DiscreteGpu => MEMORY_OF_A_CARD,
            _ => MEMORY_SHARED,
        };
        Self { context, memory: Memory::new(budget, advice), most_moved: u64::MAX, shows: None }
    }

    /// The same device with a budget of its own, in bytes, at least a mebibyte. The default is 4 GiB on a card
    /// with memory of its own and 2 GiB elsewhere.
    ///
    /// # Errors
    /// [`Error::Device`] for a budget below the least.
    pub fn with_memory(self, bytes: u64) -> Result<Self, Error> {
        if bytes < budget::LEAST {
            let (given, least) = (bytes_in_words(bytes), bytes_in_words(budget::LEAST));
            let message = format!("a GPU memory of {given} is too small; give at least {least}");
            let kind = DeviceErrorKind::OutOfMemory { asked: Some(budget::LEAST), free: Some(bytes) };
            return Err(DeviceError::new(kind, message).into());
        }
        Ok(Self { memory: Memory::new(bytes, self.context.advice), ..self })
    }

    /// Most bytes of a buffer that passes see.
    pub(crate) fn largest_binding(&self) -> u64 {
        let limits = &self.context.limits;
        limits.max_buffer_size.min(limits.max_storage_buffer_binding_size)
    }

    /// Whether software acts as the graphics card.
    pub fn is_software(&self) -> bool {
        self.context.kind == DeviceType::Cpu
    }

    /// Bytes that buffers take now: state, copies of it, uniforms and staging.
    pub fn allocated(&self) -> u64 {
        self.memory.held()
    }

    /// Bytes that buffers took at most so far.
    pub fn peak(&self) -> u64 {
        self.memory.peak()
    }

    /// Bytes that the driver says the whole device holds, where it says so: to check the count against.
    #[doc(hidden)]
    pub fn allocated_by_driver(&self) -> Option<u64> {
        self.context.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
    }

    /// Bounds what one submission moves, so that tests see work cut into many pieces.
    #[doc(hidden)]
    #[must_use]
    pub fn moving_at_most(self, bytes: u64) -> Self {
        Self { most_moved: bytes, ..self }
    }

    /// Gives the device up, as if its driver had reset it: for tests of what happens then.
    #[doc(hidden)]
    pub fn lose(&self) {
        self.context.device.destroy();
        // The listener is called when the device is next asked for anything.
        let _ = self.context.wait(None);
    }
}
