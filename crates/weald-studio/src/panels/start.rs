//! What one begins with: templates, what was open of late, and a tour of a minute.

use std::path::PathBuf;

use eframe::egui::{Id, Modal, RichText, ScrollArea, Ui, Window};
use weald::recipe::template::TEMPLATES;

use super::pictures;
use crate::studio::{Asked, Studio};

/// Heights in points: of all that the start has beside templates and files, of a file, and of templates at least.
const OTHERS: f32 = 200.0;
const ROW: f32 = 24.0;
const LEAST: f32 = 150.0;

pub(crate) fn show(studio: &mut Studio, ui: &Ui) {
    if studio.asked != Some(Asked::Start) {
        return;
    }
    let (mut template, mut open, mut asks, mut goes_on): (Option<&str>, Option<PathBuf>, bool, bool) =
        (None, None, false, false);
    let modal = Modal::new(Id::unique("start")).show(ui.ctx(), |ui| {
        ui.set_width(460.0);
        ui.heading("Begin with");
        // What stands below them stays within a window of any height.
        let below = OTHERS + ROW * studio.recent.len() as f32;
        let most = (ui.ctx().content_rect().height() - below).max(LEAST);
        ScrollArea::vertical().max_height(most).show(ui, |ui| {
            for one in TEMPLATES {
                ui.horizontal(|ui| {
                    let is_chosen = pictures::show(ui, one.name);
                    ui.vertical(|ui| {
                        if ui.button(one.name).clicked() || is_chosen {
                            template = Some(one.name);
                        }
                        ui.label(RichText::new(one.summary).weak());
                    });
                });
            }
        });
        ui.separator();
        ui.label("Or drop a recipe, a GeoTIFF or a PNG onto the window.");
        asks = ui.button("Open a file or a project …").clicked();
        if !studio.recent.is_empty() {
            ui.label("Open of late");
        }
        for path in &studio.recent {
            if ui.button(path.display().to_string()).clicked() {
                open = Some(path.clone());
            }
        }
        ui.separator();
        goes_on = ui.button("Go on with what is shown").clicked();
    });
    if let Some(name) = template {
        studio.begin_template(name);
    } else if let Some(path) = open {
        studio.open(&path);
    } else if asks {
        studio.asked = Some(Asked::Open(String::new()));
    } else if goes_on || modal.should_close() {
        studio.asked = None;
    }
}

/// What the tour says, one after the other.
const TOUR: [(&str, &str); 6] = [
    (
        "The landscape",
        "Drag to go round it, with the right button to move it aside; the wheel comes nearer to what is under the pointer. F shows it whole.",
    ),
    (
        "The recipe",
        "On the left, a card for each step. Every control has its unit, its range and what it does on hover. Ctrl+T shows the same as text.",
    ),
    ("The simulation", "On the right. Space lets it run; the slider goes back to any moment."),
    (
        "The brushes",
        "Choose one and paint on the land: material, water, springs, drains. Ctrl and the wheel make it wider, Shift and the wheel stronger; Escape gives the pointer back to the camera.",
    ),
    (
        "Undo",
        "Ctrl+Z takes back anything: strokes, settings, steps, changes of the recipe. The history is on the right.",
    ),
    (
        "Save and export",
        "Ctrl+S keeps the project as text that `weald run` understands. Ctrl+E writes what the recipe's outputs ask for. Ctrl+K finds every command.",
    ),
];

pub(crate) fn tour(studio: &mut Studio, ui: &Ui) {
    let Some(place) = studio.tour else { return };
    let Some((title, text)) = TOUR.get(place) else {
        studio.tour = None;
        return;
    };
    let mut next = Some(place);
    // One window for all pages: it stays where it was moved to.
    let window = Window::new(format!("Tour, {} of {}", place + 1, TOUR.len())).id(Id::unique("tour"));
    window.collapsible(false).resizable(false).show(ui.ctx(), |ui| {
        ui.set_width(340.0);
        ui.heading(*title);
        ui.label(*text);
        ui.horizontal(|ui| {
            if ui.button("Next").clicked() {
                next = Some(place + 1);
            }
            if ui.button("End the tour").clicked() {
                next = None;
            }
        });
    });
    studio.tour = next;
}
