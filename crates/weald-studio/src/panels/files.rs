//! Questions about files: what to open, where to save, where to export, whether to leave.

use std::path::{Path, PathBuf};

use eframe::egui::{Id, Key, Modal, TextEdit, Ui};

use crate::studio::{Asked, Studio};
use crate::work::Task;

/// What was answered.
enum Answer {
    /// The path that stands in the field.
    Path(PathBuf),
    /// Leave without saving.
    Leave,
    /// Let the page ask for a file.
    Choose,
    /// Nothing of it.
    No,
}

pub(crate) fn show(studio: &mut Studio, ui: &Ui) {
    let Some(mut asked) = studio.asked.take() else { return };
    let chooses = studio.is_hosted() && matches!(asked, Asked::Open(_));
    let (title, button, text) = match &mut asked {
        Asked::Start => {
            studio.asked = Some(asked);
            return;
        }
        Asked::Open(text) => ("Open a recipe, an elevation model or a project", "Open", Some(text)),
        Asked::SaveAs(text) => ("Save the project in this folder", "Save", Some(text)),
        Asked::Export(text) => ("Run, and write the outputs into this folder", "Export", Some(text)),
        Asked::Leave => ("There is something that is not saved", "Leave without saving", None),
    };
    let mut answer = None;
    let modal = Modal::new(Id::unique("files")).show(ui.ctx(), |ui| {
        ui.set_width(460.0);
        ui.heading(title);
        let mut path = None;
        if let Some(text) = text {
            let label = ui.label("Path");
            let response =
                ui.add(TextEdit::singleline(text).desired_width(f32::INFINITY)).labelled_by(label.id);
            if !response.has_focus() && !response.lost_focus() {
                response.request_focus();
            }
            let enters = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            path = Some(PathBuf::from(text.trim()));
            if enters {
                answer = path.clone().map(Answer::Path);
            }
        }
        ui.horizontal(|ui| {
            if ui.button(button).clicked() {
                answer = Some(path.map_or(Answer::Leave, Answer::Path));
            }
            if chooses && ui.button("Choose a file …").clicked() {
                answer = Some(Answer::Choose);
            }
            if ui.button("Cancel").clicked() {
                answer = Some(Answer::No);
            }
        });
    });
    match answer {
        Some(Answer::Path(path)) if !path.as_os_str().is_empty() => take(studio, &asked, &path),
        Some(Answer::Leave) => {
            let context = ui.ctx().clone();
            studio.leave(&context);
        }
        Some(Answer::Choose) => studio.choose_file(),
        Some(Answer::No) => {}
        _ if modal.should_close() => {}
        _ => studio.asked = Some(asked),
    }
}

fn take(studio: &mut Studio, asked: &Asked, path: &Path) {
    match asked {
        Asked::Open(_) => studio.open(path),
        Asked::SaveAs(_) => match studio.project.settle(path) {
            Ok(file) => {
                studio.work.ask(Task::Save(file));
                studio.save_cameras();
            }
            Err(error) => studio.say(error.to_string()),
        },
        Asked::Export(_) => studio.work.ask(Task::Export(path.to_owned())),
        Asked::Start | Asked::Leave => {}
    }
}
