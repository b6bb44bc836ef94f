//! Measures how long the parts of a picture take, as the least of several pictures, and counts its triangles.
//!
//! Water is shaded with the ground. How long it takes is how much longer the ground does than in the same picture without
//! water, which is drawn as well.

use std::sync::Arc;
use std::time::Duration;

use weald::Error;
use weald::picture::Camera;
use web_time::Instant;

use super::options::check_camera;
use super::picture::Readback;
use super::renderer::{Renderer, Shot};
use super::terrain::Shown;
use super::timing::{Timer, Timings};
use super::upload::Upload;

/// Longest wait for a picture that is measured: software draws a million sets blade by blade in minutes.
const TIMEOUT: Duration = Duration::from_mins(20);

impl Renderer {
    /// Draws the picture of a camera so many times, at least once, and says how long its parts take. Where there is
    /// water, each time without as well.
    ///
    /// # Errors
    /// As [`Renderer::render`]; [`Error::Device`] as well for a device that has no clock.
    pub fn measure(&mut self, camera: &Camera, times: u32) -> Result<Timings, Error> {
        self.timer = Some(Timer::new(&self.gpu)?);
        let least = self.least_of(camera, times);
        (self.timer, self.is_dry) = (None, false);
        let wet = least?;
        let Some(dry) = wet.1 else { return Ok(wet.0) };
        let water = wet.0.ground.saturating_sub(dry.ground);
        Ok(Timings { ground: wet.0.ground.min(dry.ground), water, ..wet.0 })
    }

    /// Draws the pictures of some cameras one after the other, each when the one before is done, as a window does: grass around
    /// a camera that has come far is sown meanwhile. Says how long all take by the clock of the processor.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn pace(&mut self, cameras: &[Camera]) -> Result<Duration, Error> {
        let landing = Readback::new(&self.gpu, self.own.options.size)?;
        let (context, onto) = (self.gpu.context.clone(), Arc::clone(&self.own));
        let begun = Instant::now();
        for camera in cameras {
            context.attempt("drawing", || {
                let description = wgpu::CommandEncoderDescriptor::default();
                let mut encoder = context.device.create_command_encoder(&description);
                let shot = Shot { onto: &onto, camera, target: &landing.view, waits: false };
                self.draw_shot(&mut encoder, &shot, None)?;
                context.queue.submit([encoder.finish()]);
                context.wait_at_most(TIMEOUT, None)
            })?;
        }
        Ok(begun.elapsed())
    }

    /// How many triangles the ground of a camera takes.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn triangles(&mut self, camera: &Camera) -> Result<u64, Error> {
        check_camera(camera)?;
        let device = &self.gpu.context.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut into = Upload { gpu: &self.gpu, encoder: &mut encoder };
        let shown = Shown { detail_from: camera.eye, heights_are_known: true, ..Shown::default() };
        self.terrain.prepare(&mut into, camera, self.own.options.size, shown)?;
        Ok(self.terrain.triangles())
    }

    /// The least times with water, and without where there is some.
    fn least_of(&mut self, camera: &Camera, times: u32) -> Result<(Timings, Option<Timings>), Error> {
        let mut least: [Option<Timings>; 2] = [None; 2];
        for _ in 0..times.max(1) {
            for &dry in if self.has_water { &[false, true][..] } else { &[false] } {
                self.is_dry = dry;
                let now = self.measured(camera)?;
                let least = &mut least[usize::from(dry)];
                *least = Some(least.map_or(now, |least| least.least(now)));
            }
        }
        Ok((least[0].expect("it was drawn at least once"), least[1]))
    }

    fn measured(&mut self, camera: &Camera) -> Result<Timings, Error> {
        let landing = Readback::new(&self.gpu, self.own.options.size)?;
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
            context.wait_at_most(TIMEOUT, None)
        })?;
        let picture = begun.elapsed();
        self.timer.as_ref().expect("it is set by the caller").timings(&self.gpu, picture)
    }
}
