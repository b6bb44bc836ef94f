//! What can be drawn: sizes, samples, cameras.

use weald::Error;
use weald::engine::device::Device;
use weald::error::{Limit, Quantity};
use weald::picture::Camera;

use crate::gpu::Gpu;

/// How large and how smooth pictures are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel at the edges of what is drawn: 1 or 4.
    pub samples: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { size: [1920, 1080], samples: 4 }
    }
}

/// Numbers of samples that every device has.
const SAMPLES: [u32; 2] = [1, 4];

impl Options {
    /// Refuses what a device cannot draw, before anything is allocated.
    ///
    /// # Errors
    /// [`Error::Limit`] for a size or a number of samples that it does not have.
    pub fn check(&self, gpu: &Gpu) -> Result<(), Error> {
        let most = gpu.context.limits.max_texture_dimension_2d;
        let [width, height] = self.size;
        if let Some(&side) = self.size.iter().find(|side| !(1..=most).contains(side)) {
            let limit = Limit::new(Quantity::PixelsPerSide, u64::from(side), 1..=most.into());
            let subject = format!("a picture of {width} × {height} pixels, drawn by {}", gpu.adapter());
            return Err(limit.of(subject).remedy("choose another --size").into());
        }
        if !SAMPLES.contains(&self.samples) {
            let [least, most] = SAMPLES.map(u64::from);
            let limit = Limit::new(Quantity::SamplesPerPixel, u64::from(self.samples), least..=most);
            return Err(limit.remedy("every device has these: choose --samples 4").into());
        }
        Ok(())
    }
}

/// Refuses a camera whose numbers are not finite.
pub(super) fn check_camera(camera: &Camera) -> Result<(), Error> {
    let Camera { eye, forward, right, up, half } = camera;
    let numbers = [eye, forward, right, up].into_iter().flatten().chain(half);
    if numbers.clone().all(|number| number.is_finite()) && half.iter().all(|&half| half > 0.0) {
        return Ok(());
    }
    let found: Vec<_> = numbers.map(f32::to_string).collect();
    Err(Error::Run(format!(
        "the camera has the numbers {}: all must be finite, and its angles above 0",
        found.join(" ")
    )))
}
