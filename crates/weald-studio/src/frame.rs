//! One frame of the window: what has happened, what is to be drawn, and where everything is.

use std::time::Duration;
use web_time::Instant;

use eframe::egui::{CentralPanel, Color32, Context, Popup, Pos2, Rect, Sense, Ui, Vec2, ViewportCommand};

use crate::commands::{COMMANDS, Entry, Keys};
use crate::navigation;
use crate::panels::{self, arranged, overlay};
use crate::studio::{Asked, Studio};
use crate::work::Task;

/// Time between two looks at whether something is to be kept in case that the program is killed.
const KEPT_EVERY: Duration = Duration::from_millis(500);

impl eframe::App for Studio {
    #[cfg(target_arch = "wasm32")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }

    fn logic(&mut self, context: &Context, _: &mut eframe::Frame) {
        let _span = tracing::trace_span!("what has happened").entered();
        self.status = self.work.status();
        self.take_refused();
        self.tend_host();
        self.keep();
        self.ask_before_closing(context);
        let (now, hand_is_down) = context.input(|input| (input.time, input.pointer.any_down()));
        if self.document.revision() != self.seen {
            (self.seen, self.changed_at) = (self.document.revision(), now);
        }
        self.run_changes(now, hand_is_down);
        if self.document.revision() != self.opened {
            context.request_repaint_after(Duration::from_millis(100));
        }
        let title = format!("{}{} – Weald", self.project.title(), if self.is_unsaved() { " •" } else { "" });
        if title != self.title {
            self.title.clone_from(&title);
            context.send_viewport_cmd(ViewportCommand::Title(title));
        }
        context.request_repaint_after(KEPT_EVERY);
    }

    /// A page that is left keeps what is not saved.
    #[cfg(not(target_arch = "wasm32"))]
    fn on_exit(&mut self) {
        self.project.forget_unsaved();
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let _span = tracing::trace_span!("interface").entered();
        if self.on_page.is_bare {
            CentralPanel::no_frame().show(ui, |ui| self.show_viewport(ui));
            return;
        }
        self.take_keys(ui);
        self.take_dropped(ui);
        arranged::show(self, ui);
        CentralPanel::no_frame().show(ui, |ui| self.show_viewport(ui));
        panels::start::show(self, ui);
        panels::files::show(self, ui);
        panels::seeds::show(self, ui);
        panels::palette::show(self, ui);
        panels::start::tour(self, ui);
    }
}

impl Studio {
    /// Notes what was saved, and keeps what is not.
    fn keep(&mut self) {
        if self.noted_saved != self.status.saved {
            self.noted_saved.clone_from(&self.status.saved);
            if let Some((file, state)) = &self.status.saved
                && self.project.recipe_file().as_ref() == Some(file)
            {
                self.project.saved(*state);
                self.say(self.said_of_saving());
            }
        }
        if self.kept_at.elapsed() >= KEPT_EVERY {
            self.kept_at = Instant::now();
            self.keep_unsaved();
        }
        if let Some((folder, names)) = &self.status.exported
            && self.noted_export.as_ref() != Some(folder)
        {
            self.noted_export = Some(folder.clone());
            let (folder, count) = (folder.clone(), names.len());
            let said = match self.hand_out(&folder) {
                Ok(()) if self.is_hosted() => {
                    format!("outputs are handed out in one archive: {count} of them")
                }
                Ok(()) => format!("{count} files are in {}", folder.display()),
                Err(error) => error.to_string(),
            };
            self.say(said);
        }
    }

    /// Writes what is not saved, in case that the program is killed: by the thread that works, or the text alone where that
    /// cannot run.
    fn keep_unsaved(&mut self) {
        let state = self.state();
        if self.document.diagnostics().is_empty() {
            // A copy that is written after what was saved would be taken up in place of it.
            let saves = self.status.done < self.saving;
            if self.opened == state.revision
                && !saves
                && let Some(file) = self.project.keep(&self.own, state)
            {
                self.work.ask(Task::Keep(file));
            }
        } else if let Err(error) = self.project.keep_text(&self.own, state, self.document.text()) {
            self.say(error.to_string());
        }
    }

    fn ask_before_closing(&mut self, context: &Context) {
        let wants = context.input(|input| input.viewport().close_requested());
        if wants && self.is_unsaved() && !self.is_closing {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.asked = Some(Asked::Leave);
        }
    }

    fn take_keys(&mut self, ui: &Ui) {
        let context = ui.ctx().clone();
        let types = context.egui_wants_keyboard_input();
        // A key with Shift is one without it too, to those who ask for that first.
        let has_shift = |entry: &&Entry| matches!(entry.keys, Keys::Shift(_));
        let rest = COMMANDS.iter().filter(|entry| !has_shift(entry));
        for entry in COMMANDS.iter().filter(has_shift).chain(rest) {
            let Some(keys) = entry.keys.shortcut() else { continue };
            // A letter alone is typed where text is typed; questions and lists have keys of their own.
            if (types || self.is_asking() || Popup::is_any_open(&context)) && !keys.modifiers.command {
                continue;
            }
            if context.input_mut(|input| input.consume_shortcut(&keys)) {
                self.obey(entry.command, &context);
            }
        }
    }

    /// Whether a question lies over the window.
    fn is_asking(&self) -> bool {
        self.asked.is_some() || self.palette.is_some() || self.sheet.is_some()
    }

    fn take_dropped(&mut self, ui: &Ui) {
        if self.is_hosted() {
            // The page itself takes what is dropped on it.
            return;
        }
        let dropped = ui.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_owned()));
        if let Some(path) = dropped {
            self.open(&path);
        }
    }

    fn show_viewport(&mut self, ui: &mut Ui) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.ctx.accesskit_node_builder(response.id, |node| node.set_label("Viewport"));
        self.bring_up_to_date();
        self.handle(ui, &response, rect);
        self.turn(ui.ctx());
        self.draw(ui, rect);
        panels::masked::show(self, ui, rect);
        overlay::show(self, ui, rect);
        panels::marks::show(self, ui, rect);
        panels::section::show(self, ui, rect);
    }

    /// Gives the viewport the landscape and the surface that there are now.
    fn bring_up_to_date(&mut self) {
        let Some(viewport) = &mut self.viewport else { return };
        if let Some(shown) = &self.status.shown {
            let view = self.looks.view(&shown.landscape);
            viewport.order(shown, (&view, self.looks_number), self.status.held.is_some());
        }
        viewport.take_built();
        // A landscape of another extent would lie far away, or all around.
        let middle = viewport.middle().map(|[east, north, _]| [east, north]);
        if self.camera.is_none() || middle != self.framed {
            (self.camera, self.framed) = (viewport.whole(), middle);
        }
        if let Some(surface) = &self.status.surface
            && let Err(error) = viewport.follow(surface)
        {
            viewport.fail(&error);
        }
    }

    fn draw(&mut self, ui: &Ui, rect: Rect) {
        let (Some(viewport), Some(camera)) = (&mut self.viewport, self.camera) else { return };
        let pixels = rect.size() * ui.ctx().pixels_per_point();
        let full = [pixels.x, pixels.y].map(|side| (side as u32).max(16));
        let Some(whole) = viewport.whole() else { return };
        let camera = navigation::framed(camera, whole.half, full);
        self.camera = Some(camera);
        match viewport.draw(&camera, full) {
            Ok(Some(again)) => ui.ctx().request_repaint_after(again),
            Ok(None) => {}
            Err(error) => viewport.fail(&error),
        }
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        if let Some(texture) = viewport.texture() {
            ui.painter().image(texture, rect, whole, Color32::WHITE);
        }
        if let Some(texture) = viewport.pinned_texture() {
            // The same place of the picture on both sides of the bar.
            let part = |rect: Rect| {
                Rect::from_min_size(rect.min, Vec2::new(self.wipe * rect.width(), rect.height()))
            };
            ui.painter().image(texture, part(rect), part(whole), Color32::WHITE);
        }
    }
}
