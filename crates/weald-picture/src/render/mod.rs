//! The view rasterised on a graphics device, with grass and plants: the same scene from the same keys.

mod camera_path;
mod device;

pub use camera_path::CameraPath;
pub use device::{GrassRate, RayMarched, RenderDevice, RenderRequest, Rendering};

use super::{Camera, LitScene, View};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Diagnostics, Parameter, Parameters, Places};
use weald_core::source::Table;

weald_core::parameters! {
    /// Keys of `render` that a view has not, or has otherwise.
    pub struct RenderKeys {
        /// MSAA samples per pixel: 4, or 1 with aliased edges.
        samples: u32 = 4, range 1..=4;
        /// Further places, `[x, y]` as `eye` has them, that the camera flies through after `eye`, at the same height
        /// above the ground; it looks ahead, or at `target`. It goes with `eye` and `frames`.
        through: Option<Places> = None, with eye;
    }
}

/// Least height of a camera above the ground, in metres.
const MIN_CLEARANCE: f64 = 0.1;

/// A view rasterised on a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Render {
    /// Light, air, size and camera.
    pub view: View,
    /// All else.
    pub keys: RenderKeys,
}

impl Parameters for Render {
    fn parameters() -> Vec<Parameter> {
        let own = RenderKeys::parameters();
        let is_own = |parameter: &Parameter| own.iter().any(|key| key.name == parameter.name);
        let mut all: Vec<_> = View::parameters().into_iter().filter(|key| !is_own(key)).collect();
        all.extend(own);
        all
    }

    fn read_values(table: &Table, diagnostics: &mut Diagnostics) -> Self {
        let keys = RenderKeys::read_values(table, diagnostics);
        if let Some(samples) = table.get("samples").filter(|_| ![1, 4].contains(&keys.samples)) {
            let message = format!("`samples` is {}, but must be 1 or 4", keys.samples);
            diagnostics.add(samples.line, message);
        }
        // A view has `samples` too, with another range and default.
        let mut of_view = table.clone();
        of_view.take("samples");
        Self { view: View::read_values(&of_view, diagnostics), keys }
    }

    fn changed(&self, table: &Table, diagnostics: &mut Diagnostics) -> Self {
        let mut of_view = table.clone();
        of_view.take("samples");
        Self { view: self.view.changed(&of_view, diagnostics), keys: self.keys.changed(table, diagnostics) }
    }
}

/// Which frame of how many, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Counted from 0.
    pub number: u64,
    /// How many there are; 1 for a still.
    pub count: u64,
    /// Moment in seconds.
    pub seconds: f64,
}

impl Frame {
    /// The only picture.
    pub const STILL: Self = Self { number: 0, count: 1, seconds: 0.0 };
}

/// The scene of a `render` on a device, for one frame after the other.
#[derive(Debug)]
pub struct FrameSequence<'a> {
    render: &'a Render,
    scene: LitScene,
    device: &'a dyn RenderDevice,
    landscape: &'a Landscape,
    camera_path: Option<CameraPath>,
}

impl Render {
    /// Checks that a device can draw it.
    ///
    /// # Errors
    /// As [`RenderDevice::check`].
    pub fn check(&self, device: &dyn RenderDevice) -> Result<(), Error> {
        device.check([self.view.width, self.view.height], self.keys.samples)
    }

    /// Makes a landscape ready to be drawn, as a still or a film.
    ///
    /// # Errors
    /// As [`LitScene::new`].
    pub fn frame_sequence<'a>(
        &'a self,
        landscape: &'a Landscape,
        device: &'a dyn RenderDevice,
    ) -> Result<FrameSequence<'a>, Error> {
        let scene = LitScene::with_crags(&self.view, landscape)?;
        let camera_path = self.keys.through.as_ref().map(|through| self.camera_path(&scene, through));
        let frame_sequence = FrameSequence { render: self, scene, device, landscape, camera_path };
        let first = frame_sequence.camera(Frame::STILL);
        Ok(FrameSequence { scene: frame_sequence.scene.seen_from(first), ..frame_sequence })
    }

    fn camera_path(&self, scene: &LitScene, through: &Places) -> CameraPath {
        let begin = self.view.eye.iter().flat_map(|eye| &eye.0).take(1);
        let points = begin.chain(&through.0).map(|&place| self.standing(scene, place)).collect();
        let target = self.view.target.as_ref().and_then(|target| target.0.first());
        CameraPath { points, target: target.map(|&place| scene.above_ground(place, 0.0)) }
    }

    fn standing(&self, scene: &LitScene, place: [f64; 2]) -> [f32; 3] {
        scene.above_ground(place, self.height_above_ground())
    }

    fn height_above_ground(&self) -> f64 {
        self.view.eye_height.max(MIN_CLEARANCE)
    }
}

impl FrameSequence<'_> {
    /// The scene on the device, for one picture.
    ///
    /// # Errors
    /// As [`RenderDevice::set_up`].
    pub fn set_up(&self) -> Result<Box<dyn Rendering + '_>, Error> {
        self.set_up_for(false)
    }

    /// The scene on the device, for the frames of a film.
    ///
    /// # Errors
    /// As [`RenderDevice::set_up`].
    pub fn set_up_film(&self) -> Result<Box<dyn Rendering + '_>, Error> {
        self.set_up_for(true)
    }

    fn set_up_for(&self, is_film: bool) -> Result<Box<dyn Rendering + '_>, Error> {
        let Self { render, scene, landscape, .. } = self;
        let samples = render.keys.samples;
        self.device.set_up(&RenderRequest { view: &render.view, scene, landscape, samples, is_film })
    }

    /// The camera of a frame.
    pub fn camera(&self, frame: Frame) -> Camera {
        let Frame { number, count, .. } = frame;
        if let Some(camera_path) = &self.camera_path {
            let share = number as f64 / count.saturating_sub(1).max(1) as f64;
            let camera = camera_path.camera(share, self.scene.camera());
            return self.scene.kept_above_ground(camera, self.render.height_above_ground());
        }
        let view = &self.render.view;
        if count > 1 {
            return self.scene.camera_of(&view.turned(number as f64 / count as f64));
        }
        let camera = self.scene.camera_of(view);
        match view.eye.as_ref().and_then(|eye| eye.0.first()) {
            // A device draws grass from a height at which a view is lifted above the ground.
            Some(&place) if view.turn_deg.is_none() => camera.at(self.render.standing(&self.scene, place)),
            _ => camera,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Field, Size};

    #[test]
    fn a_camera_between_two_points_goes_over_the_hill_that_stands_between_them() {
        let size = Size::square(32).expect("small");
        let mut land = Landscape::new(Domain::new(size, 10.0));
        let hill = |x: usize, _: usize| 100.0 * libm::expf(-((x as f32 - 16.0) / 4.0).powi(2));
        land.insert("height", "m", Field::from_function(size, hill));
        let scene = LitScene::new(&View::default(), &land).expect("ground");
        let standing = |east: f64| scene.above_ground([east, 160.0], 1.7);
        let camera_path = CameraPath { points: vec![standing(20.0), standing(300.0)], target: None };
        let heights = (0..=20).map(|frame| {
            let along = camera_path.camera(f64::from(frame) / 20.0, scene.camera());
            let eye = scene.kept_above_ground(along, 1.7).eye;
            let ground = scene.above_ground([f64::from(eye[0]), f64::from(-eye[1])], 0.0)[2];
            assert!(eye[2] >= along.eye[2] && eye[2] - ground > 1.69, "{} m", eye[2] - ground);
            eye[2]
        });
        assert!(heights.fold(0.0, f32::max) > 90.0, "it went round the hill");
    }
}
