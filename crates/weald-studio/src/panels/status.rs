//! What is going on, along the foot: work and its progress, what is under the pointer, how fast it goes, and messages.

use std::fmt::Write;
use std::time::Duration;

use eframe::egui::{ProgressBar, RichText, Ui};

use crate::studio::Studio;
use crate::work::Phase;

/// How long a message stays.
const MESSAGE: Duration = Duration::from_secs(12);

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    if let Some(error) = &studio.status.error {
        ui.label(RichText::new(error).color(ui.visuals().error_fg_color));
    }
    for note in &studio.status.notes {
        ui.label(RichText::new(note).color(ui.visuals().warn_fg_color));
    }
    if studio.message.as_ref().is_some_and(|(_, since)| since.elapsed() > MESSAGE) {
        studio.message = None;
    }
    ui.horizontal(|ui| {
        work(studio, ui);
        ui.separator();
        pointed(studio, ui);
        ui.separator();
        pace(studio, ui);
        if let Some((message, _)) = &studio.message {
            ui.separator();
            ui.label(RichText::new(message).strong());
        }
    });
}

fn work(studio: &Studio, ui: &mut Ui) {
    match &studio.status.phase {
        Phase::Idle => drop(ui.label("Ready")),
        Phase::Simulating => drop(ui.label("Simulating")),
        Phase::Writing(file) => drop(ui.label(format!("Writing {file}"))),
        Phase::Running { step, count, name, share } => {
            let text = format!("Step {step} of {count}: {name}");
            if let Some(share) = share {
                ui.add(ProgressBar::new(*share).text(text).desired_width(220.0));
            } else {
                ui.spinner();
                ui.label(text);
            }
        }
    }
}

/// Where the pointer is, and what lies there.
fn pointed(studio: &Studio, ui: &mut Ui) {
    let Some(place) = studio.pointed else {
        ui.label("–");
        return;
    };
    let [east, south] = place.at;
    let mut text = format!("{east:.0} m east, {south:.0} m south: {:.1} m", place.ground);
    if place.water > 0.0 {
        let _ = write!(text, ", water {:.2} m", place.water);
    }
    let layer = studio.looks.layer.as_ref();
    let value = layer.zip(studio.status.shown.as_ref()).and_then(|(name, shown)| {
        let [x, y] = place.cell;
        shown.landscape.field(name).ok().map(|field| (name, field.at(x, y)))
    });
    if let Some((name, value)) = value {
        let _ = write!(text, ", {name} {value:.4}");
    }
    ui.label(text);
}

fn pace(studio: &Studio, ui: &mut Ui) {
    if studio.status.pace > 0.0 {
        let engine = format!("simulated by {}", studio.status.engine);
        ui.label(format!("{:.0} steps/s", studio.status.pace)).on_hover_text(engine);
    }
    if let Some(viewport) = &studio.viewport {
        let device = viewport.device();
        let text = format!("{:.0} ms a picture", 1000.0 * viewport.seconds());
        let text =
            if viewport.is_software() { format!("{text} (no graphics card: software draws)") } else { text };
        ui.label(text).on_hover_text(device);
    }
}
