//! Ways to look and to compare: cameras that were kept, a turntable, a moment that is pinned, a line that is measured.

use eframe::egui::Context;

use super::Studio;
use crate::cameras;
use crate::navigation;
use crate::pick::{Place, Target};
use crate::work::Surface;

/// Degrees that the turntable goes in a second.
const TURN_DEG: f64 = 12.0;

impl Studio {
    /// Ground and water of the simulation, where they are newer than the landscape.
    pub(crate) fn surface(&self) -> Option<&Surface> {
        let shown = self.status.shown.as_ref()?;
        self.status.surface.as_ref().filter(|surface| surface.shown == shown.number)
    }

    /// The ground and the water that the pointer meets.
    pub(crate) fn target(&self) -> Option<Target<'_>> {
        let shown = self.status.shown.as_ref()?;
        let (surface, height) = (self.surface(), shown.landscape.field("height").ok()?);
        let water = surface.map(|surface| &surface.canvas.water);
        Some(Target {
            ground: surface.map_or(height, |surface| &surface.ground),
            water: water.or_else(|| shown.landscape.field("water").ok()),
            cell: shown.landscape.domain.cell,
            lowest: f64::from(shown.lowest),
            exaggeration: self.looks.exaggeration,
        })
    }

    /// Draws the line that is measured to what is under the pointer, anew where it begins.
    pub(super) fn measure(&mut self, from: Option<Place>) {
        if let Some(from) = from {
            self.measuring.line = Some([from.at; 2]);
        }
        if let (Some(line), Some(to)) = (&mut self.measuring.line, self.pointed) {
            line[1] = to.at;
        }
    }

    /// Moves the camera on where the turntable runs.
    pub(crate) fn turn(&mut self, context: &Context) {
        let Some(camera) = self.camera.filter(|_| self.turns) else { return };
        let Some(middle) = self.viewport.as_ref().and_then(|viewport| viewport.middle()) else { return };
        let seconds = f64::from(context.input(|input| input.stable_dt.min(0.25)));
        self.camera = Some(camera.turned(middle, TURN_DEG * seconds));
        context.request_repaint();
    }

    /// Pins what is shown, to compare what comes with it, or lets it go.
    pub(super) fn pin(&mut self) {
        let Some(viewport) = &mut self.viewport else { return };
        if viewport.has_pinned() {
            return viewport.pin(None);
        }
        let Some(shown) = &self.status.shown else { return };
        viewport.pin(Some((shown, self.looks.view(&shown.landscape))));
        self.wipe = 0.5;
        self.say("pinned on the left, up to the bar that can be dragged; the same key lets it go");
    }

    /// Keeps where the camera is, under the name that was typed.
    pub(crate) fn keep_camera(&mut self) {
        let Some(camera) = self.camera else { return };
        let name = std::mem::take(&mut self.camera_name);
        let name = if name.is_empty() { format!("camera {}", self.cameras.len() + 1) } else { name };
        let above = camera.eye[2] - self.sea_level();
        self.cameras.push((name, camera.at([camera.eye[0], camera.eye[1], above])));
        self.save_cameras();
    }

    /// Puts the camera where it was kept.
    pub(crate) fn go_to_camera(&mut self, place: usize) {
        let Some((_, kept)) = self.cameras.get(place) else { return };
        let [east, north, above] = kept.eye;
        self.camera = Some(kept.at([east, north, above + self.sea_level()]));
        self.mode = navigation::Mode::Orbit;
    }

    /// Height at which an elevation of 0 is drawn: kept cameras count from it, for the lowest ground changes.
    fn sea_level(&self) -> f32 {
        self.viewport.as_ref().and_then(|viewport| viewport.drawn_height(0.0)).unwrap_or(0.0)
    }

    /// Writes the cameras beside the recipe; before the project has a folder, they wait for it.
    pub(crate) fn save_cameras(&mut self) {
        if let Some(file) = self.project.cameras_file()
            && let Err(error) = weald::io::write_whole(&file, cameras::to_text(&self.cameras).as_bytes())
        {
            self.say(error.to_string());
        }
    }

    pub(super) fn read_cameras(&mut self) {
        self.cameras = Vec::new();
        let Some(file) = self.project.cameras_file().filter(|file| weald::files::is_file(file)) else {
            return;
        };
        let read = weald::files::read_to_string(&file).map_err(|cause| cause.to_string());
        match read.and_then(|text| cameras::of_text(&text)) {
            Ok(cameras) => self.cameras = cameras,
            Err(cause) => self.say(format!("{}: {cause}", file.display())),
        }
    }
}
