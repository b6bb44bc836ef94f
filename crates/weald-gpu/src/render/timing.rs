//! How long the passes of a picture take, by the device's own clock.

use std::time::{Duration, Instant};

use weald::Error;
use weald::picture::Camera;
use wgpu::{
    BufferUsages, CommandEncoder, ComputePassDescriptor, ComputePassTimestampWrites, Features, QuerySet,
    QuerySetDescriptor, QueryType, RenderPass, RenderPassTimestampWrites,
};

use super::Renderer;
use super::picture::{Landing, landed};
use crate::gpu::Gpu;
use crate::memory::Store;

/// What a device needs for it.
pub(crate) const FEATURES: Features =
    Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_PASSES);

/// Moments of a picture, in order.
#[derive(Clone, Copy, Debug)]
pub(super) enum Moment {
    ChoiceBegins,
    ChoiceEnds,
    ShadowsBegin,
    ShadowsEnd,
    LightBegins,
    GroundEnds,
    BehindEnds,
    LightEnds,
    FilmBegins,
    FilmEnds,
}

/// How many moments there are.
const MOMENTS: u32 = 10;

/// Bytes of a moment.
const BYTES: u64 = 8;

/// How long the parts of a picture took, the least of several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timings {
    /// What throws shadows, into all cascades.
    pub shadows: Duration,
    /// The ground and the water on it.
    pub ground: Duration,
    /// Cut sides, plain and sky.
    pub behind: Duration,
    /// What is chosen of the grass.
    pub choice: Duration,
    /// Blades of grass.
    pub grass: Duration,
    /// From light to the numbers of a picture.
    pub film: Duration,
    /// All of it, from choosing what is drawn to the end of the device's work.
    pub picture: Duration,
}

/// The clock of a device.
#[derive(Debug)]
pub(super) struct Timer {
    moments: QuerySet,
    resolved: Store,
    landing: Store,
}

impl Timer {
    /// The clock of a device that has one.
    fn new(gpu: &Gpu) -> Result<Self, Error> {
        if !gpu.context.device.features().contains(FEATURES) {
            return Err(Error::Device(format!("{} has no clock that passes can read", gpu.context.adapter)));
        }
        let bytes = BYTES * u64::from(MOMENTS);
        let usage = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
        let description =
            QuerySetDescriptor { label: Some("moments"), ty: QueryType::Timestamp, count: MOMENTS };
        Ok(Self {
            moments: gpu.context.device.create_query_set(&description),
            resolved: Store::new(gpu, "moments", bytes, usage)?,
            landing: Store::new(gpu, "moments", bytes, BufferUsages::COPY_DST | BufferUsages::MAP_READ)?,
        })
    }

    /// What a pass notes at its ends.
    pub(super) fn around(&self, begin: Option<Moment>, end: Option<Moment>) -> RenderPassTimestampWrites<'_> {
        RenderPassTimestampWrites {
            query_set: &self.moments,
            beginning_of_pass_write_index: begin.map(|moment| moment as u32),
            end_of_pass_write_index: end.map(|moment| moment as u32),
        }
    }

    /// What a pass that computes notes at its ends.
    pub(super) fn around_compute(&self, begin: Moment, end: Moment) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.moments,
            beginning_of_pass_write_index: Some(begin as u32),
            end_of_pass_write_index: Some(end as u32),
        }
    }

    /// Notes both moments of a choice that there is none of: every moment is to be noted once.
    pub(super) fn skip_choice(&self, encoder: &mut CommandEncoder) {
        let timestamp_writes = Some(self.around_compute(Moment::ChoiceBegins, Moment::ChoiceEnds));
        drop(encoder.begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes }));
    }

    /// Notes a moment within a pass.
    pub(super) fn note(&self, pass: &mut RenderPass<'_>, moment: Moment) {
        pass.write_timestamp(&self.moments, moment as u32);
    }

    fn collect(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.moments, 0..MOMENTS, &self.resolved.buffer, 0);
        let bytes = BYTES * u64::from(MOMENTS);
        encoder.copy_buffer_to_buffer(&self.resolved.buffer, 0, &self.landing.buffer, 0, bytes);
    }

    /// Times between the moments of the picture that was drawn last, which took so long in all.
    fn timings(&self, gpu: &Gpu, picture: Duration, planted: bool) -> Result<Timings, Error> {
        let ticks = landed(gpu, &self.landing.buffer, bytemuck::pod_collect_to_vec::<u8, u64>)?;
        let tick = f64::from(gpu.context.queue.get_timestamp_period()) * 1e-9;
        let between = |from: Moment, to: Moment| {
            Duration::from_secs_f64(ticks[to as usize].saturating_sub(ticks[from as usize]) as f64 * tick)
        };
        let of_grass = |from, to| if planted { between(from, to) } else { Duration::ZERO };
        Ok(Timings {
            shadows: between(Moment::ShadowsBegin, Moment::ShadowsEnd),
            ground: between(Moment::LightBegins, Moment::GroundEnds),
            behind: between(Moment::GroundEnds, Moment::BehindEnds),
            choice: of_grass(Moment::ChoiceBegins, Moment::ChoiceEnds),
            grass: of_grass(Moment::BehindEnds, Moment::LightEnds),
            film: between(Moment::FilmBegins, Moment::FilmEnds),
            picture,
        })
    }
}

impl Timings {
    fn least(self, other: Self) -> Self {
        Self {
            shadows: self.shadows.min(other.shadows),
            ground: self.ground.min(other.ground),
            behind: self.behind.min(other.behind),
            choice: self.choice.min(other.choice),
            grass: self.grass.min(other.grass),
            film: self.film.min(other.film),
            picture: self.picture.min(other.picture),
        }
    }
}

impl Renderer {
    /// Draws the picture of a camera so many times, at least once, and says how long its parts take.
    ///
    /// # Errors
    /// As [`Renderer::render`]; [`Error::Device`] as well for a device that has no clock.
    pub fn measure(&mut self, camera: &Camera, times: u32) -> Result<Timings, Error> {
        self.timer = Some(Timer::new(&self.gpu)?);
        let mut least = self.measured(camera);
        for _ in 1..times {
            let next = self.measured(camera);
            least = least.and_then(|least| Ok(least.least(next?)));
        }
        self.timer = None;
        least
    }

    fn measured(&mut self, camera: &Camera) -> Result<Timings, Error> {
        let landing = Landing::new(&self.gpu, self.options.size)?;
        let context = self.gpu.context.clone();
        let begun = Instant::now();
        context.attempt("drawing", || {
            let mut encoder =
                context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.encode(camera, &mut encoder, &landing.view)?;
            if let Some(timer) = &self.timer {
                timer.collect(&mut encoder);
            }
            context.queue.submit([encoder.finish()]);
            context.wait(None)
        })?;
        let picture = begun.elapsed();
        self.timer.as_ref().expect("it is set by the caller").timings(
            &self.gpu,
            picture,
            self.grass.is_some(),
        )
    }
}
