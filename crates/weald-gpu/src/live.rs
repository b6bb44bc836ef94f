//! Ground and water of a simulation as it runs, kept on the device for those who draw it: nothing is read back.
//!
//! A program whose device was given a [`Live`] by [`Gpu::shown_in`] adds up its ground and copies its water after each
//! batch of steps (`live.wgsl`): 8 bytes per cell written, 8 and 4 a plane read. A renderer follows it by
//! [`Renderer::follow`](crate::Renderer::follow).

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use weald::Error;
use weald::edit::Canvas;
use weald::engine::device::ShownGround;
use weald::grid::Size;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, BufferUsages, CommandEncoderDescriptor,
    ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions,
    ShaderModuleDescriptor, ShaderSource,
};

use crate::gpu::{Gpu, Shown, Shows};
use crate::memory::Store;
use crate::transfer;

/// Cells along the side of a workgroup.
const GROUP: u32 = 16;

/// Ground and water of a landscape that are shown as a simulation goes on. Copies show the same.
#[derive(Clone, Debug)]
pub struct Live {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    size: Size,
    numbers: Store,
    ground: Store,
    depth: Store,
    pipeline: OnceLock<ComputePipeline>,
    place: Mutex<Option<Place>>,
    generation: AtomicU64,
}

/// How the grid of the simulation lies in the landscape.
#[derive(Clone, Copy, Debug)]
struct Place {
    size: Size,
    first: [i32; 2],
    unit: f32,
    lowest: f32,
}

impl Live {
    /// Room for a landscape of that size: 8 bytes per cell.
    ///
    /// # Errors
    /// [`Error::Device`] where the device's memory does not suffice.
    pub fn new(gpu: &Gpu, size: Size) -> Result<Self, Error> {
        let bytes = 4 * size.cells() as u64;
        let store = |what| Store::new(gpu, what, bytes, BufferUsages::STORAGE | BufferUsages::COPY_DST);
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let shared = Shared {
            size,
            numbers: Store::new(gpu, "how a simulation lies in its landscape", 48, usage)?,
            ground: store("the ground that is shown")?,
            depth: store("the water that is shown")?,
            pipeline: OnceLock::new(),
            place: Mutex::default(),
            generation: AtomicU64::new(0),
        };
        Ok(Self { shared: Arc::new(shared) })
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        self.shared.size
    }

    /// How many times it has changed: batches of steps of the programs that it shows.
    pub fn generation(&self) -> u64 {
        self.shared.generation.load(Ordering::Acquire)
    }

    /// Brings the ground and water of some cells to the device, of a simulation that runs elsewhere or of a stroke: no more
    /// than those, and without waiting.
    ///
    /// # Errors
    /// [`Error::Run`] for cells that the landscape does not have, [`Error::Device`] where the device has failed.
    pub fn paint(&self, gpu: &Gpu, canvas: &Canvas) -> Result<(), Error> {
        gpu.context.check("painting")?;
        let ([left, upper], size, whole) = (canvas.first, canvas.size(), self.shared.size);
        if left + size.columns > whole.columns || upper + size.rows > whole.rows {
            let message =
                format!("{size} cells from column {left} and row {upper} on are not within {whole}");
            return Err(Error::Run(message));
        }
        for row in 0..size.rows {
            let cells = row * size.columns..(row + 1) * size.columns;
            let ground: Vec<f32> = cells.clone().map(|cell| canvas.surface(cell) as f32).collect();
            let at = 4 * ((upper + row) * whole.columns + left) as u64;
            let rows = [&ground[..], &canvas.water.values()[cells]];
            for (store, row) in self.stores().into_iter().zip(rows) {
                gpu.context.queue.write_buffer(&store.buffer, at, bytemuck::cast_slice(row));
            }
        }
        self.shared.generation.fetch_add(1, Ordering::AcqRel);
        Ok(())
    }

    /// Ground in metres, and the depth of water on it.
    pub(crate) fn stores(&self) -> [&Store; 2] {
        [&self.shared.ground, &self.shared.depth]
    }

    /// A panic elsewhere leaves it whole, since it is only ever replaced.
    fn place(&self) -> MutexGuard<'_, Option<Place>> {
        self.shared.place.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shows for Live {
    /// One of a landscape of another size is not shown.
    fn begin(&self, gpu: &Gpu, ground: &ShownGround<'_>) -> Result<(), Error> {
        let shared = &*self.shared;
        let fits = ground.start.size() == shared.size;
        if fits {
            transfer::write(gpu, &shared.ground.buffer, bytemuck::cast_slice(ground.start.values()))?;
            if let Some(water) = ground.water {
                transfer::write(gpu, &shared.depth.buffer, bytemuck::cast_slice(water.values()))?;
            }
        }
        let ShownGround { size, first, unit, lowest, .. } = *ground;
        *self.place() = fits.then_some(Place { size, first, unit, lowest });
        Ok(())
    }

    /// What is not the whole simulation, such as a tile, is not shown.
    fn take(&self, gpu: &Gpu, size: Size, shown: &Shown<'_>) -> Result<(), Error> {
        let Some(place) = self.place().filter(|place| place.size == size) else { return Ok(()) };
        let shared = &*self.shared;
        let whole = [shared.size.columns, shared.size.rows].map(|side| side as u32);
        gpu.context.attempt("showing a simulation", || {
            let pipeline = shared.pipeline.get_or_init(|| pipeline(gpu));
            gpu.context.queue.write_buffer(&shared.numbers.buffer, 0, &place.bytes(whole, shown));
            let group = shared.bind(gpu, pipeline, shown);
            let mut encoder = gpu.context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            let [across, down] = whole.map(|side| side.div_ceil(GROUP));
            pass.dispatch_workgroups(across, down, 1);
            drop(pass);
            gpu.context.queue.submit([encoder.finish()]);
            Ok(())
        })?;
        shared.generation.fetch_add(1, Ordering::AcqRel);
        Ok(())
    }
}

impl Gpu {
    /// The same device, whose programs show ground and water as they run.
    #[must_use]
    pub fn shown_in(&self, live: &Live) -> Self {
        Self { shows: Some(Arc::new(live.clone())), ..self.clone() }
    }
}

impl Shared {
    fn bind(&self, gpu: &Gpu, pipeline: &ComputePipeline, shown: &Shown<'_>) -> BindGroup {
        let or_base = |part: Option<(&'_ Buffer, u32)>| part.map_or(shown.base, |(buffer, _)| buffer).clone();
        let buffers = [
            self.numbers.buffer.clone(),
            shown.base.clone(),
            shown.added.0.clone(),
            or_base(shown.water),
            or_base(shown.mask),
            self.ground.buffer.clone(),
            self.depth.buffer.clone(),
        ];
        let entries: Vec<_> = (0..)
            .zip(&buffers)
            .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let layout = &pipeline.get_bind_group_layout(0);
        let description = BindGroupDescriptor { label: Some("show"), layout, entries: &entries };
        gpu.context.device.create_bind_group(&description)
    }
}

impl Place {
    /// The shader's struct.
    fn bytes(&self, whole: [u32; 2], shown: &Shown<'_>) -> Vec<u8> {
        let lanes = |part: Option<(&Buffer, u32)>| part.map_or(0, |(_, lanes)| lanes);
        let [columns, rows] = [self.size.columns, self.size.rows].map(|side| side as u32);
        let [first_column, first_row] = self.first.map(|first| first as u32);
        let (added, water, mask) = (shown.added.1, lanes(shown.water), lanes(shown.mask));
        let words = [whole[0], whole[1], columns, rows, first_column, first_row, added, water, mask];
        let words = words.into_iter().chain([self.unit.to_bits(), self.lowest.to_bits(), 0]);
        words.flat_map(u32::to_le_bytes).collect()
    }
}

fn pipeline(gpu: &Gpu) -> ComputePipeline {
    let source = ShaderSource::Wgsl(include_str!("live.wgsl").into());
    let module =
        gpu.context.device.create_shader_module(ShaderModuleDescriptor { label: Some("show"), source });
    gpu.context.device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some("show"),
        layout: None,
        module: &module,
        entry_point: Some("show"),
        compilation_options: PipelineCompilationOptions::default(),
        cache: None,
    })
}
