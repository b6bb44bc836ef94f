//! The device that the library knows.

use std::sync::Arc;

use weald::Error;
use weald::engine::device::{Device, Loaded, ShownGround};
use weald::engine::program::Program;
use weald::grid::Size;
use wgpu::DeviceType;

use crate::adapter::{self, Wanted};
use crate::advice::{Advice, DRAWING, SIMULATION};
use crate::context::Context;
use crate::live::Live;
use crate::memory::{self, Memory};
use crate::running::Running;

/// Budget of a card with memory of its own. Drivers do not tell wgpu how much there is; cards with less are
/// rare.
const MEMORY_OF_A_CARD: u64 = 4 << 30;

/// Budget where the memory is the machine's own and others need it too.
const MEMORY_SHARED: u64 = 2 << 30;

/// A compute device and a budget of its memory. Clones share both.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(crate) context: Arc<Context>,
    pub(crate) memory: Arc<Memory>,
    /// Bytes that one submission may move at most, where tests set a bound.
    pub(crate) most_moved: u64,
    /// Where ground and water of running programs are shown.
    pub(crate) live: Option<Live>,
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
        let adapter = adapter::best(adapters, wanted).ok_or_else(|| adapter::none(&found, wanted))?;
        Self::open(&adapter, &SIMULATION)
    }

    fn open(adapter: &wgpu::Adapter, advice: &'static Advice) -> Result<Self, Error> {
        let context = Arc::new(Context::open(adapter, advice)?);
        let budget = match context.kind {
            DeviceType::DiscreteGpu => MEMORY_OF_A_CARD,
            _ => MEMORY_SHARED,
        };
        Ok(Self { context, memory: Memory::new(budget, advice), most_moved: u64::MAX, live: None })
    }

    /// The same device with a budget of its own, in bytes, at least a mebibyte. The default is 4 GiB on a card
    /// with memory of its own and 2 GiB elsewhere.
    ///
    /// # Errors
    /// [`Error::Device`] for a budget below the least.
    pub fn with_memory(self, bytes: u64) -> Result<Self, Error> {
        if bytes < memory::LEAST {
            let (given, least) = (memory::in_words(bytes), memory::in_words(memory::LEAST));
            return Err(Error::Device(format!(
                "a GPU memory of {given} is too small; give at least {least}"
            )));
        }
        Ok(Self { memory: Memory::new(bytes, self.context.advice), ..self })
    }

    /// The same device, whose programs show ground and water as they run.
    #[must_use]
    pub fn shown_in(&self, live: &Live) -> Self {
        Self { live: Some(live.clone()), ..self.clone() }
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
        // The listener hears of it when the device is next asked for anything.
        let _ = self.context.wait(None);
    }
}

impl Device for Gpu {
    fn adapter(&self) -> String {
        self.context.adapter.clone()
    }

    fn memory(&self) -> u64 {
        self.memory.budget()
    }

    fn largest_buffer(&self) -> u64 {
        self.largest_binding()
    }

    fn load(&self, program: &Program, size: Size) -> Result<Box<dyn Loaded>, Error> {
        Ok(Box::new(Running::new(self.clone(), program, size)?))
    }

    fn shows(&self, ground: &ShownGround<'_>) -> Result<(), Error> {
        self.live.as_ref().map_or(Ok(()), |live| live.begin(self, ground))
    }
}
