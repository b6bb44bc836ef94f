//! What the library asks of a device that draws. The crate `weald-gpu` answers; here is no GPU interface.

use std::fmt::Debug;

use crate::{Camera, Image, LitScene, View};
use weald_core::error::{DeviceError, DeviceErrorKind, Error};
use weald_core::landscape::Landscape;

/// A device that draws stages.
pub trait RenderDevice: Debug + Send + Sync {
    /// The adapter and its driver, for the report.
    fn adapter(&self) -> String;

    /// Refuses pictures that it cannot draw, before anything is allocated.
    ///
    /// # Errors
    /// [`Error::Limit`] for a size in pixels or a number of samples that it does not have.
    fn check(&self, size: [u32; 2], samples: u32) -> Result<(), Error>;

    /// Brings what is to be shown to the device.
    ///
    /// # Errors
    /// As [`RenderDevice::check`]; [`Error::Device`] where its memory does not suffice or it fails.
    fn set_up<'a>(&self, request: &RenderRequest<'a>) -> Result<Box<dyn Rendering + 'a>, Error>;

    /// How fast it draws fields of grass as those of tables 1 to 3 of Kim and Cho 2009, of up to so many sets.
    ///
    /// # Errors
    /// [`Error::Device`] where it fails, draws no blades or has no clock.
    fn grass_rates(&self, most_sets: u32) -> Result<Vec<GrassRate>, Error>;
}

/// How fast a field of grass is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct GrassRate {
    /// Number of the source's table, 1 to 3.
    pub table: u8,
    /// From where it is seen.
    pub view: &'static str,
    /// Level of growth, 1 to 4.
    pub level: f32,
    /// Sets that are there.
    pub sets: u64,
    /// Sets that are drawn.
    pub drawn: u64,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Frames per second.
    pub rate: f64,
    /// The same in the source.
    pub source: f64,
}

/// What a device is to draw.
#[derive(Clone, Copy, Debug)]
pub struct RenderRequest<'a> {
    /// Light, air and size of the pictures.
    pub view: &'a View,
    /// The view of the landscape, made ready.
    pub scene: &'a LitScene,
    /// The landscape, with what grows on it.
    pub landscape: &'a Landscape,
    /// Samples per pixel at edges, 1 or 4.
    pub samples: u32,
    /// Whether it is a frame of many: one picture may take its time for what is far away.
    pub is_film: bool,
}

/// A scene on a device.
pub trait Rendering: Debug {
    /// The picture of a camera at a moment in seconds, by which water flows and grass sways.
    ///
    /// # Errors
    /// [`Error::Run`] for a camera whose numbers are not finite, [`Error::Device`] where the device fails.
    fn draw(&mut self, camera: &Camera, seconds: f64) -> Result<Image, Error>;
}

/// The ray-marched view in place of a device: neither grass nor plants nor waves, and nothing moves but the camera.
#[derive(Clone, Copy, Debug)]
pub struct RayMarched;

impl RenderDevice for RayMarched {
    fn adapter(&self) -> String {
        "the processor, ray-marched".to_owned()
    }

    fn check(&self, _: [u32; 2], _: u32) -> Result<(), Error> {
        Ok(())
    }

    fn set_up<'a>(&self, request: &RenderRequest<'a>) -> Result<Box<dyn Rendering + 'a>, Error> {
        Ok(Box::new(RayMarchedScene { view: request.view, landscape: request.landscape }))
    }

    fn grass_rates(&self, _: u32) -> Result<Vec<GrassRate>, Error> {
        let kind = DeviceErrorKind::Unsupported { feature: "blades of grass" };
        Err(DeviceError::new(kind, "the ray-marched view draws no blades of grass").into())
    }
}

#[derive(Debug)]
struct RayMarchedScene<'a> {
    view: &'a View,
    landscape: &'a Landscape,
}

impl Rendering for RayMarchedScene<'_> {
    fn draw(&mut self, camera: &Camera, _: f64) -> Result<Image, Error> {
        self.view.seen_from(self.landscape, *camera)
    }
}
