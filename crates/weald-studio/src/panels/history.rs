//! What was done by hand, stroke by stroke: one click goes there, and what comes after it can be redone.

use eframe::egui::{Button, RichText, TextEdit, Ui};

use super::cameras::NAME;
use crate::studio::Studio;
use crate::work::Task;

/// Most lines that are shown: the last ones.
const MOST_SHOWN: usize = 200;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.separator();
    ui.heading("History");
    let mut wanted = None;
    let is_at_start = studio.status.moments.iter().all(|moment| !moment.is_past);
    if ui.selectable_label(is_at_start, "Start").clicked() {
        wanted = Some(0);
    }
    let moments = &studio.status.moments;
    let last = moments.iter().rposition(|moment| moment.is_past);
    let first = moments.len().saturating_sub(MOST_SHOWN);
    for (place, moment) in moments.iter().enumerate().skip(first) {
        let text = RichText::new(format!("{} · {}", moment.steps, moment.label));
        let text = if moment.is_past { text } else { text.weak() };
        if ui.selectable_label(last == Some(place), text).clicked() {
            wanted = Some(moment.number);
        }
    }
    names(studio, ui, &mut wanted);
    if let Some(moment) = wanted {
        studio.act(Task::GoTo(moment));
    }
}

/// Moments with names, of any branch, to come back to.
fn names(studio: &mut Studio, ui: &mut Ui, wanted: &mut Option<usize>) {
    if studio.status.held.is_none() {
        return;
    }
    ui.horizontal(|ui| {
        let label = ui.label("Name");
        ui.add(TextEdit::singleline(&mut studio.name).desired_width(NAME)).labelled_by(label.id);
        if ui
            .button("Keep")
            .on_hover_text("Give this moment a name, to come back to it from any branch")
            .clicked()
            && !studio.name.is_empty()
        {
            studio.work.ask(Task::Name(std::mem::take(&mut studio.name)));
        }
    });
    let mut renamed = None;
    for (name, moment) in &studio.status.names {
        ui.horizontal(|ui| {
            if ui.button(name).on_hover_text("Go to this moment").clicked() {
                *wanted = Some(*moment);
            }
            let hover = format!("Give {name} the name that is typed above");
            let can = !studio.name.is_empty();
            if ui.add_enabled(can, Button::new("rename").small()).on_hover_text(hover).clicked() {
                renamed = Some(name.clone());
            }
        });
    }
    if let Some(from) = renamed {
        studio.work.ask(Task::Rename { from, to: std::mem::take(&mut studio.name) });
    }
}
