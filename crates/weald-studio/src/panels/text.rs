//! The recipe as text, with what is wrong at its lines.

use eframe::egui::{FontId, ScrollArea, TextEdit, Ui};

use crate::studio::Studio;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    let label = ui.heading("Recipe as text");
    super::steps::diagnostics(studio, ui);
    let mut text = studio.document.text().to_owned();
    ScrollArea::both().show(ui, |ui| {
        let edit = TextEdit::multiline(&mut text)
            .code_editor()
            .font(FontId::monospace(12.0))
            .desired_width(f32::INFINITY)
            .desired_rows(40);
        let response = ui.add(edit).labelled_by(label.id);
        if response.changed() {
            let changes = studio.document.changes().count();
            studio.document.type_text(&text);
            if studio.document.changes().count() > changes {
                studio.edited(Ok(()));
            }
        }
    });
}
