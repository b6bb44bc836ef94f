//! What each command does.

use std::path::PathBuf;

use eframe::egui::{Context, Theme, ViewportCommand};

use weald::error::Diagnostic;

use super::{Asked, Left, Palette, Sheet, Studio};
use crate::brushes::Tool;
use crate::commands::Command;
use crate::project::Start;
use crate::work::Task;

/// Narrowest and widest brush, in metres.
const RADII: std::ops::RangeInclusive<f64> = 0.1..=1e6;

impl Studio {
    /// Does what a command says.
    pub(crate) fn obey(&mut self, command: Command, context: &Context) {
        match command {
            Command::New => self.asked = Some(Asked::Start),
            Command::Open => self.asked = Some(Asked::Open(String::new())),
            Command::Save => self.save(),
            Command::SaveAs => self.asked = Some(Asked::SaveAs(self.project.suggested())),
            Command::Export => self.asked = Some(Asked::Export(self.project.export_folder())),
            Command::Seeds => self.open_sheet(),
            Command::Undo => self.undo(),
            Command::Redo => self.redo(),
            Command::Play => self.play(!self.status.plays),
            Command::Step => self.act_on_held(Task::Advance(1)),
            Command::PlayToEnd => self.act_on_held(Task::PlayToEnd),
            Command::ToStart => self.act_on_held(Task::GoTo(0)),
            Command::Frame | Command::TopView | Command::Camera(_) => self.place_camera(command),
            Command::Turntable => self.turns = !self.turns,
            Command::KeepCamera => self.keep_camera(),
            Command::Measure => {
                self.choose(Tool::None);
                self.measuring.is_on = true;
            }
            Command::Pin => self.pin(),
            Command::Brush(tool) => self.choose(tool),
            Command::Wider => self.widen(1.25),
            Command::Narrower => self.widen(0.8),
            Command::Stronger => self.brush.strength = (self.brush.strength * 1.1).min(1.0),
            Command::Weaker => self.brush.strength = (self.brush.strength / 1.1).max(0.01),
            Command::Palette => self.palette = Some(Palette::default()),
            Command::Text => {
                self.left = if self.left == Left::Text { Left::Cards } else { Left::Text };
            }
            Command::Theme => {
                let is_dark = context.theme() == Theme::Dark;
                context.set_theme(if is_dark { Theme::Light } else { Theme::Dark });
            }
            Command::Larger => context.set_zoom_factor((context.zoom_factor() * 1.1).min(4.0)),
            Command::Smaller => context.set_zoom_factor((context.zoom_factor() / 1.1).max(0.5)),
            Command::Picture => self.take_picture(),
            Command::Tour => self.tour = Some(0),
            Command::Quit => context.send_viewport_cmd(ViewportCommand::Close),
        }
    }

    /// Begins with a template.
    pub(crate) fn begin_template(&mut self, name: &str) {
        match weald::recipe::template::find(name) {
            Ok(template) => self.begin(Start::of_template(template)),
            Err(message) => self.say(message),
        }
    }

    fn choose(&mut self, tool: Tool) {
        if tool.density().is_some() && self.document.growing().is_empty() {
            return self.say("there are no plants: add a step that grows some, `grass` or `scatter`");
        }
        if tool != Tool::None && tool.density().is_none() && self.status.held.is_none() {
            return self.say(
                "there is nothing to paint on: add a step that erodes, such as `hydraulic` or `fluvial`",
            );
        }
        (self.brush.tool, self.stroke) = (tool, None);
        self.measuring.is_on = false;
    }

    fn widen(&mut self, factor: f64) {
        self.brush.radius = (self.brush.radius * factor).clamp(*RADII.start(), *RADII.end());
    }

    fn play(&mut self, plays: bool) {
        if plays {
            self.act_on_held(Task::Play(true));
        } else {
            self.work.ask(Task::Play(false));
        }
    }

    fn act_on_held(&mut self, task: Task) {
        if self.status.held.is_some() {
            self.act(task);
        } else {
            self.say("no step of the recipe can be run by hand: add one that erodes, such as `hydraulic` or `fluvial`");
        }
    }

    /// Closes without asking again.
    pub(crate) fn leave(&mut self, context: &Context) {
        self.is_closing = true;
        context.send_viewport_cmd(ViewportCommand::Close);
    }

    /// What is said once the project is saved.
    pub(crate) fn said_of_saving(&self) -> String {
        if self.document.diagnostics().is_empty() {
            return "saved".to_owned();
        }
        let what = self.first_wrong();
        format!(
            "saved as it last ran; what is typed now is kept beside it, in typed.toml, for it cannot run: {what}"
        )
    }

    /// Saves the project where it is, or asks where.
    pub(crate) fn save(&mut self) {
        match self.project.recipe_file() {
            Some(file) => self.save_in(file),
            None => self.asked = Some(Asked::SaveAs(self.project.suggested())),
        }
    }

    /// Saves the project, whose recipe is this file.
    pub(crate) fn save_in(&mut self, file: PathBuf) {
        if self.has_run() {
            self.work.ask(Task::Save(file));
            self.saving = self.work.asked();
        } else {
            self.save_typed();
        }
        self.save_cameras();
    }

    /// Saves a text of which nothing has run yet: there is nothing else that could be saved.
    fn save_typed(&mut self) {
        let state = self.state();
        match self.project.save_text(self.document.text(), state) {
            Ok(true) => self.say(format!("saved as it is typed; it cannot run yet: {}", self.first_wrong())),
            Ok(false) => self.say(self.said_of_saving()),
            Err(error) => self.say(error.to_string()),
        }
    }

    /// What is wrong with the text first, with its line.
    fn first_wrong(&self) -> String {
        let Some(wrong) = self.document.diagnostics().first() else { return String::new() };
        let place =
            if wrong.line == Diagnostic::NO_LINE { String::new() } else { format!("line {}: ", wrong.line) };
        format!("{place}{}", wrong.message)
    }

    /// Asks which seeds are to be seen beside each other.
    fn open_sheet(&mut self) {
        let folder = self.project.seeds_folder();
        self.sheet = Some(Sheet { first: 1, count: 12, folder });
    }

    fn take_picture(&mut self) {
        if self.is_hosted() {
            return self.say("a page cannot wait for a picture: add a `view` to the outputs and export");
        }
        let (Some(viewport), Some(camera)) = (&mut self.viewport, self.camera) else { return };
        let size = [2560, 1440];
        let Some(whole) = viewport.whole() else { return };
        let camera = crate::navigation::framed(camera, whole.half, size);
        let drawn = viewport.picture(&camera, size).map_err(|error| error.to_string());
        let said = drawn.and_then(|image| match image {
            Some(image) => {
                let file = self.project.picture_file();
                weald::io::write_whole(&file, &image.to_png(&[])).map_err(|error| error.to_string())?;
                Ok(format!("{} is written", file.display()))
            }
            None => Ok("there is no picture yet".to_owned()),
        });
        self.say(said.unwrap_or_else(|error| error));
    }
}
