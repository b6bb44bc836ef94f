//! The pointer and the keys over the viewport: they move the camera, or paint.

use eframe::egui::{self, Key, Modifiers, PointerButton, Rect, Response, TouchPhase, Ui};
use weald::picture::Camera;

use super::Studio;
use crate::brushes::{Settings, Stroke, Tool};
use crate::commands::Command;
use crate::navigation::{self, EYE_HEIGHT, Mode};
use crate::pick::Place;
use crate::work::Task;

/// Share of the way through the landscape that flying goes in a second, and metres that walking does.
const FLIGHT: f32 = 0.15;
const WALK: f32 = 4.0;

impl Studio {
    /// Places the camera as a command says.
    pub(super) fn place_camera(&mut self, command: Command) {
        let Some(viewport) = &self.viewport else { return };
        let (Some(whole), Some(middle)) = (viewport.whole(), viewport.middle()) else { return };
        match command {
            Command::Camera(mode) => {
                self.mode = mode;
                if mode == Mode::Walk {
                    self.begin_to_walk(middle);
                }
                return;
            }
            Command::TopView => {
                let distance = navigation::distance(&whole, middle);
                let eye = [middle[0], middle[1], middle[2] + distance];
                self.camera = Some(Camera::looking(eye, [0.0, 0.0, -1.0], whole.half));
            }
            _ => self.camera = Some(whole),
        }
        self.mode = Mode::Orbit;
    }

    /// What is under a point of the viewport now.
    fn under(&self, camera: &Camera, rect: Rect, at: egui::Pos2) -> Option<Place> {
        let across = 2.0 * (at.x - rect.center().x) / rect.width();
        let up = -2.0 * (at.y - rect.center().y) / rect.height();
        self.target()?.pick(camera, [across, up])
    }

    /// What is under a point of the window, where the viewport has this place in it.
    pub(crate) fn under_pointer(&self, rect: Rect, at: egui::Pos2) -> Option<Place> {
        self.under(&self.camera?, rect, at)
    }

    /// Takes what the hand does over the viewport. Gives whether it moved anything.
    pub(crate) fn handle(&mut self, ui: &Ui, response: &Response, rect: Rect) {
        let Some(camera) = self.camera else { return };
        self.pointed = response.hover_pos().and_then(|at| self.under(&camera, rect, at));
        let paints = self.paints();
        if paints {
            self.paint(ui, response);
        }
        let measures = self.measuring.is_on;
        if measures && response.dragged_by(PointerButton::Primary) {
            // A drag is known for one only after some points.
            let from = response.drag_started().then(|| ui.input(|input| input.pointer.press_origin()));
            let from = from.flatten().and_then(|at| self.under(&camera, rect, at));
            self.measure(from);
        }
        self.drag(response, rect, camera, paints || measures);
        self.wheel(ui, response, paints);
        self.fly(ui);
    }

    fn drag(&mut self, response: &Response, rect: Rect, camera: Camera, is_busy: bool) {
        let delta = response.drag_delta();
        let share = [delta.x / rect.width(), delta.y / rect.height()];
        let Some(middle) = self.viewport.as_ref().and_then(|viewport| viewport.middle()) else { return };
        let pans = response.dragged_by(PointerButton::Middle)
            || (response.dragged_by(PointerButton::Secondary) && self.mode == Mode::Orbit);
        let turns = (response.dragged_by(PointerButton::Primary) && !is_busy)
            || (response.dragged_by(PointerButton::Secondary) && self.mode != Mode::Orbit);
        if pans {
            let distance = navigation::distance(&camera, middle);
            self.camera = Some(navigation::pan(camera, distance, share));
        } else if turns {
            let turned = match self.mode {
                Mode::Orbit => navigation::orbit(camera, middle, share),
                Mode::Fly | Mode::Walk => navigation::look_about(camera, share),
            };
            self.camera = Some(turned);
        }
    }

    /// The wheel zooms towards what is under the pointer; with Ctrl it makes the brush wider, with Shift stronger.
    fn wheel(&mut self, ui: &Ui, response: &Response, paints: bool) {
        if !response.hovered() {
            return;
        }
        let (scroll, zoom, modifiers) =
            ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta(), input.modifiers));
        if paints && modifiers.command && (zoom - 1.0).abs() > 1e-4 {
            self.brush.radius = (self.brush.radius * f64::from(zoom)).clamp(0.1, 1e6);
            return;
        }
        let notches = scroll / 40.0;
        if notches.abs() < 1e-3 {
            return;
        }
        if paints && modifiers.shift {
            self.brush.strength = (self.brush.strength * f64::from(1.0 + 0.1 * notches)).clamp(0.01, 1.0);
            return;
        }
        let Some(camera) = self.camera else { return };
        let towards = self.pointed.map_or_else(
            || self.viewport.as_ref().and_then(|viewport| viewport.middle()),
            |place| self.point(place),
        );
        if let Some(towards) = towards {
            self.camera = Some(navigation::zoom(camera, towards, notches));
        }
    }

    /// A place as a point of the camera's own coordinates.
    pub(crate) fn point(&self, place: Place) -> Option<[f32; 3]> {
        let height = self.viewport.as_ref()?.drawn_height(place.ground)?;
        Some([place.at[0] as f32, -place.at[1] as f32, height])
    }

    fn fly(&mut self, ui: &Ui) {
        if self.mode == Mode::Orbit || ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let Some(camera) = self.camera else { return };
        let (heading, seconds, runs) = ui.input(|input| {
            let axis = |plus: Key, minus: Key| {
                f32::from(u8::from(input.key_down(plus))) - f32::from(u8::from(input.key_down(minus)))
            };
            let heading = [axis(Key::W, Key::S), axis(Key::D, Key::A), axis(Key::E, Key::Q)];
            (heading, input.stable_dt.min(0.1), input.modifiers.shift)
        });
        if heading == [0.0; 3] {
            return;
        }
        let extent = self.status.shown.as_ref().map_or(1000.0, |shown| {
            shown.landscape.domain.cell as f32 * shown.landscape.domain.size.columns as f32
        });
        let pace = if self.mode == Mode::Walk { WALK } else { FLIGHT * extent };
        let metres = pace * seconds * if runs { 4.0 } else { 1.0 };
        self.camera = Some(navigation::go(camera, heading.map(|part| part * metres), self.mode));
        if self.mode == Mode::Walk {
            self.stand();
        }
        ui.ctx().request_repaint();
    }

    /// Puts the camera on the ground below it, or in the middle of the land where it is beside that, and looks ahead.
    fn begin_to_walk(&mut self, middle: [f32; 3]) {
        let (Some(camera), Some(target)) = (self.camera, self.target()) else { return };
        let [east, north, _] = camera.eye;
        let is_above_land = target.at([f64::from(east), f64::from(-north)]).is_some();
        let eye = if is_above_land { camera.eye } else { middle };
        self.camera = Some(Camera::looking(eye, navigation::ahead(&camera), camera.half));
        self.stand();
    }

    /// Puts the camera on the ground below it.
    fn stand(&mut self) {
        let (Some(camera), Some(target)) = (self.camera, self.target()) else { return };
        let [east, north, _] = camera.eye;
        let Some(place) = target.at([f64::from(east), f64::from(-north)]) else { return };
        let Some(ground) = self.viewport.as_ref().and_then(|viewport| viewport.drawn_height(place.ground))
        else {
            return;
        };
        self.camera = Some(camera.at([east, north, ground + EYE_HEIGHT * self.looks.exaggeration as f32]));
    }

    /// Paints where the pointer goes with its button down.
    fn paint(&mut self, ui: &Ui, response: &Response) {
        let modifiers: Modifiers = ui.input(|input| input.modifiers);
        let is_down = response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down());
        self.feel(ui);
        if is_down && self.stroke.is_none() {
            let Some(place) = self.pointed else { return };
            let material = self.brush.material_of(&self.status.materials).to_owned();
            let settings = Settings { material, ..self.brush.clone() };
            let mut stroke = Stroke::new(settings, place.at, place.ground);
            if let Some(pressure) = self.pressure {
                stroke.press(pressure);
            }
            if stroke.density().is_some() {
                self.stroke = Some(stroke);
            } else if let Some(brush) = stroke.whole() {
                self.strokes += 1;
                self.act(Task::Stroke { brush, stroke: self.strokes, replaces: false });
                self.stroke = Some(stroke);
            }
            return;
        }
        let (Some(stroke), Some(place)) = (&mut self.stroke, self.pointed) else {
            if !is_down {
                self.plant();
                self.stroke = None;
            }
            return;
        };
        if let Some(pressure) = self.pressure {
            stroke.press(pressure);
        }
        let goes_on = stroke.go_on(place.at, modifiers.shift);
        if stroke.density().is_some() {
            if !is_down {
                self.plant();
            }
            return;
        }
        // Into a running simulation the brush pours on and on; what stands still is touched once, however often the line
        // passes it.
        let runs = self.status.plays;
        let brush = if runs { stroke.piece() } else { stroke.whole() };
        if let (true, Some(brush)) = (goes_on, brush) {
            self.work.ask(Task::Stroke { brush, stroke: self.strokes, replaces: !runs });
        }
        if !is_down {
            self.stroke = None;
        }
    }

    /// Whether the pointer paints.
    pub(crate) fn paints(&self) -> bool {
        let is_about_plants = self.brush.tool.density().is_some();
        self.brush.tool != Tool::None && (is_about_plants || self.status.held.is_some())
    }

    /// Ends a stroke that is about plants: it becomes a part of the recipe, and what grows runs again.
    fn plant(&mut self) {
        let Some(stroke) = self.stroke.take_if(|stroke| stroke.density().is_some()) else { return };
        let (Some(density), Some(brush)) = (stroke.density(), stroke.whole()) else { return };
        let growing = self.document.growing();
        let Some((at, _)) = growing.get(self.brush.plants).or_else(|| growing.first()) else { return };
        let painted = self.document.paint_density(*at, &brush, density);
        self.edited(painted.map(drop));
    }

    /// How hard a pen is pressed, as long as it touches.
    fn feel(&mut self, ui: &Ui) {
        ui.input(|input| {
            for event in &input.events {
                if let egui::Event::Touch { phase, force, .. } = event {
                    let is_over = matches!(phase, TouchPhase::End | TouchPhase::Cancel);
                    self.pressure = force.filter(|_| !is_over).map(f64::from);
                }
            }
        });
    }
}
