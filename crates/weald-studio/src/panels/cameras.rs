//! Places of the camera that were kept, to come back to.

use eframe::egui::{TextEdit, Ui};

use crate::studio::Studio;

/// Width of the field for a name, in points.
pub(super) const NAME: f32 = 110.0;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label("Camera");
        ui.add(TextEdit::singleline(&mut studio.camera_name).desired_width(NAME)).labelled_by(label.id);
        let keeps = ui
            .button("Keep camera")
            .on_hover_text("Keep where the camera is under this name; it is saved with the project")
            .clicked();
        if keeps {
            studio.keep_camera();
        }
    });
    let (mut goes, mut lets_go) = (None, None);
    for (place, (name, _)) in studio.cameras.iter().enumerate() {
        ui.horizontal(|ui| {
            if ui.button(name).on_hover_text("Put the camera here").clicked() {
                goes = Some(place);
            }
            let hover = format!("Forget the camera {name}");
            if ui.small_button("forget").on_hover_text(hover).clicked() {
                lets_go = Some(place);
            }
        });
    }
    if let Some(place) = goes {
        studio.go_to_camera(place);
    }
    if let Some(place) = lets_go {
        studio.cameras.remove(place);
        studio.save_cameras();
    }
}
