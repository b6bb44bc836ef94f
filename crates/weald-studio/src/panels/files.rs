//! Questions about files: what to open, where to save, where to export, whether to leave.

use std::path::{Path, PathBuf};

use eframe::egui::{Id, Key, Modal, TextEdit, Ui};

use super::export;
use crate::dialogs::{self, Dialog, Wanted};
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
    let wanted = match &asked {
        Asked::Open(_) => Wanted::File,
        _ => Wanted::Folder,
    };
    if let Some(path) = chosen(studio) {
        if wanted == Wanted::File {
            return take(studio, &asked, &path);
        }
        if let Asked::SaveAs(text) | Asked::Export(text) = &mut asked {
            *text = path.display().to_string();
        }
    }
    let chooses = if studio.is_hosted() { wanted == Wanted::File } else { studio.chooser.is_some() };
    let exports = matches!(asked, Asked::Export(_));
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
        let has_path = path.is_some();
        if exports {
            export::show(studio, ui);
        }
        ui.horizontal(|ui| {
            if ui.button(button).clicked() {
                answer = Some(path.map_or(Answer::Leave, Answer::Path));
            }
            let choose = if wanted == Wanted::File { "Choose a file …" } else { "Choose a folder …" };
            if chooses && has_path && ui.button(choose).clicked() {
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
        Some(Answer::Choose) if studio.is_hosted() => studio.choose_file(),
        Some(Answer::Choose) => {
            studio.dialog = studio.chooser.as_ref().map(|chooser| Dialog::open(chooser, wanted));
            studio.asked = Some(asked);
        }
        Some(Answer::No) => {}
        _ if modal.should_close() => {}
        _ => studio.asked = Some(asked),
    }
}

/// The path that was chosen in a dialog of the system, once there is one.
fn chosen(studio: &mut Studio) -> Option<PathBuf> {
    let answer = studio.dialog.as_ref()?.answer();
    if answer != dialogs::Answer::Waits {
        studio.dialog = None;
    }
    match answer {
        dialogs::Answer::Chosen(path) => return Some(path),
        dialogs::Answer::NoDialog => {
            studio.say("this system shows no dialog for files (no desktop portal, no zenity): type the path");
        }
        dialogs::Answer::Waits | dialogs::Answer::Left => {}
    }
    None
}

fn take(studio: &mut Studio, asked: &Asked, path: &Path) {
    match asked {
        Asked::Open(_) => studio.open(path),
        Asked::SaveAs(_) => match studio.project.settle(path) {
            Ok(file) => studio.save_in(file),
            Err(error) => studio.say(error.to_string()),
        },
        Asked::Export(_) => {
            let outputs = export::chosen(studio);
            studio.work.ask(Task::Export { folder: path.to_owned(), outputs });
        }
        Asked::Start | Asked::Leave => {}
    }
}
