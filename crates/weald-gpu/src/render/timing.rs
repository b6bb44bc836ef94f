//! How long the passes of a picture take, by the device's own clock.
//!
//! Each part ends with a timestamp, and lasts from the one before: parts add up to the whole. A software device
//! (llvmpipe) bins what is drawn and notes a timestamp only when it draws the bins, together with what comes next; so each
//! timestamp is followed by a spare one, which makes it draw. There the processor makes the vertices of a part while it still
//! draws the one before, and the borders between parts are soft.

use std::time::Duration;

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind};
use wgpu::{
    BufferUsages, CommandEncoder, ComputePassDescriptor, ComputePassTimestampWrites, QuerySet,
    QuerySetDescriptor, QueryType, RenderPass, RenderPassTimestampWrites,
};

use super::picture::read_back;
use crate::gpu::Gpu;
use crate::gpu::context::CLOCK;
use crate::memory::Store;

/// Moments of a picture, in order: its beginning, then the end of each part.
#[derive(Clone, Copy, Debug)]
pub(super) enum Timestamp {
    Begin,
    Choice,
    Shadows,
    Depths,
    Grass,
    Plants,
    Ground,
    Behind,
    ToneMapping,
}

/// How many timestamps there are, with their spare ones.
const TIMESTAMPS: u32 = 18;

/// Bytes of a timestamp.
const BYTES: u64 = 8;

impl Timestamp {
    fn slot(self) -> u32 {
        2 * self as u32
    }

    fn spare(self) -> u32 {
        self.slot() + 1
    }
}

/// How long the parts of a picture took, the least of several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timings {
    /// What is chosen of grass and plants.
    pub choice: Duration,
    /// What is chosen of scattered plants, what throws shadows, into all cascades, and what all blades of a set have in
    /// common.
    pub shadows: Duration,
    /// The ground and its cut sides, without water.
    pub ground: Duration,
    /// By how much longer the ground takes with the water on it.
    pub water: Duration,
    /// Plain and sky.
    pub behind: Duration,
    /// Blades of grass.
    pub grass: Duration,
    /// Scattered plants.
    pub plants: Duration,
    /// From light to the numbers of a picture.
    pub tone_mapping: Duration,
    /// All of it, by the clock of the processor, from choosing what is drawn to the end of the device's work.
    pub picture: Duration,
}

/// The clock of a device.
#[derive(Debug)]
pub(super) struct Timer {
    timestamps: QuerySet,
    resolved: Store,
    landing: Store,
}

impl Timer {
    /// The clock of a device that has one.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, Error> {
        if !gpu.context.device.features().contains(CLOCK) {
            let kind = DeviceErrorKind::Unsupported { feature: "clock" };
            let message = format!("{} has no clock that passes can read", gpu.context.adapter);
            return Err(DeviceError::new(kind, message).into());
        }
        let bytes = BYTES * u64::from(TIMESTAMPS);
        let usage = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
        let description =
            QuerySetDescriptor { label: Some("timestamps"), ty: QueryType::Timestamp, count: TIMESTAMPS };
        Ok(Self {
            timestamps: gpu.context.device.create_query_set(&description),
            resolved: Store::new(gpu, "timestamps", bytes, usage)?,
            landing: Store::new(gpu, "timestamps", bytes, BufferUsages::COPY_DST | BufferUsages::MAP_READ)?,
        })
    }

    /// Notes the beginning.
    pub(super) fn begin(&self, encoder: &mut CommandEncoder) {
        let writes = ComputePassTimestampWrites {
            query_set: &self.timestamps,
            beginning_of_pass_write_index: Some(Timestamp::Begin.slot()),
            end_of_pass_write_index: Some(Timestamp::Begin.spare()),
        };
        drop(
            encoder
                .begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes: Some(writes) }),
        );
    }

    /// What a pass notes whose end is that of a part; of a part of several passes the first has no end, the last no
    /// beginning.
    pub(super) fn around(
        &self,
        timestamp: Timestamp,
        [first, last]: [bool; 2],
    ) -> RenderPassTimestampWrites<'_> {
        RenderPassTimestampWrites {
            query_set: &self.timestamps,
            beginning_of_pass_write_index: first.then(|| timestamp.spare()),
            end_of_pass_write_index: last.then(|| timestamp.slot()),
        }
    }

    /// What the pass that chooses notes.
    pub(super) fn around_choice(&self) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.timestamps,
            beginning_of_pass_write_index: Some(Timestamp::Choice.spare()),
            end_of_pass_write_index: Some(Timestamp::Choice.slot()),
        }
    }

    /// Notes the end of a choice that there is none of: every timestamp is to be noted once.
    pub(super) fn skip_choice(&self, encoder: &mut CommandEncoder) {
        let timestamp_writes = Some(self.around_choice());
        drop(encoder.begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes }));
    }

    /// Notes the beginning of the shadows, of which there may be none to draw.
    pub(super) fn begin_shadows(&self, encoder: &mut CommandEncoder) {
        let writes = ComputePassTimestampWrites {
            query_set: &self.timestamps,
            beginning_of_pass_write_index: Some(Timestamp::Shadows.spare()),
            end_of_pass_write_index: None,
        };
        drop(
            encoder
                .begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes: Some(writes) }),
        );
    }

    /// Notes the end of the shadows.
    pub(super) fn end_shadows(&self, encoder: &mut CommandEncoder) {
        let writes = ComputePassTimestampWrites {
            query_set: &self.timestamps,
            beginning_of_pass_write_index: None,
            end_of_pass_write_index: Some(Timestamp::Shadows.slot()),
        };
        drop(
            encoder
                .begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes: Some(writes) }),
        );
    }

    /// Notes the end of a part within a pass.
    pub(super) fn note(&self, pass: &mut RenderPass<'_>, timestamp: Timestamp) {
        pass.write_timestamp(&self.timestamps, timestamp.slot());
        pass.write_timestamp(&self.timestamps, timestamp.spare());
    }

    /// Brings the timestamps of a picture to where they can be read.
    pub(super) fn collect(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.timestamps, 0..TIMESTAMPS, &self.resolved.buffer, 0);
        let bytes = BYTES * u64::from(TIMESTAMPS);
        encoder.copy_buffer_to_buffer(&self.resolved.buffer, 0, &self.landing.buffer, 0, bytes);
    }

    /// Times between the timestamps of the picture that was drawn last, which took so long in all.
    pub(super) fn timings(&self, gpu: &Gpu, picture: Duration) -> Result<Timings, Error> {
        let ticks = read_back(gpu, &self.landing.buffer, bytemuck::pod_collect_to_vec::<u8, u64>)?;
        let tick = f64::from(gpu.context.queue.get_timestamp_period()) * 1e-9;
        let until = |timestamp: Timestamp| {
            let [from, to] = [timestamp.slot() - 2, timestamp.slot()].map(|slot| ticks[slot as usize]);
            Duration::from_secs_f64(to.saturating_sub(from) as f64 * tick)
        };
        Ok(Timings {
            choice: until(Timestamp::Choice),
            shadows: until(Timestamp::Shadows),
            ground: until(Timestamp::Depths) + until(Timestamp::Ground),
            water: Duration::ZERO,
            behind: until(Timestamp::Behind),
            grass: until(Timestamp::Grass),
            plants: until(Timestamp::Plants),
            tone_mapping: until(Timestamp::ToneMapping),
            picture,
        })
    }
}

impl Timings {
    /// The lesser of each part.
    pub(super) fn least(self, other: Self) -> Self {
        Self {
            choice: self.choice.min(other.choice),
            shadows: self.shadows.min(other.shadows),
            ground: self.ground.min(other.ground),
            water: self.water.min(other.water),
            behind: self.behind.min(other.behind),
            grass: self.grass.min(other.grass),
            plants: self.plants.min(other.plants),
            tone_mapping: self.tone_mapping.min(other.tone_mapping),
            picture: self.picture.min(other.picture),
        }
    }
}
