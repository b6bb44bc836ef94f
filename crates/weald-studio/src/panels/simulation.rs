//! The simulation that is held: run, stood still, stepped, and changed while it runs.

use eframe::egui::{CollapsingHeader, ProgressBar, Slider, Ui};
use weald::edit::Setting;
use weald::recipe::catalog;
use weald::recipe::source::{self, Value};

use super::controls::{self, Turned};
use super::toolbar::button;
use crate::commands::Command;
use crate::document::Document;
use crate::studio::Studio;
use crate::work::Task;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.heading("Simulation");
    let Some(held) = studio.status.held else {
        ui.label(
            "This recipe has no step that runs by hand. Add one that erodes, such as hydraulic or fluvial.",
        );
        return;
    };
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for command in [Command::Play, Command::Step, Command::PlayToEnd, Command::ToStart] {
            chosen = button(ui, command).or(chosen);
        }
    });
    if let Some(command) = chosen {
        let context = ui.ctx().clone();
        studio.obey(command, &context);
    }
    let (steps, written) = (studio.status.steps, studio.status.written_steps.max(1));
    let share = (steps as f32 / written as f32).min(1.0);
    ui.add(ProgressBar::new(share).text(format!("{steps} of {written} steps")));
    timeline(studio, ui);
    settings(studio, ui, held);
}

/// Back and forth over all that was done.
fn timeline(studio: &mut Studio, ui: &mut Ui) {
    let moments = &studio.status.moments;
    if moments.is_empty() {
        return;
    }
    let now = moments.iter().filter(|moment| moment.is_past).count();
    let mut place = now;
    let label = ui.label("Moment");
    let slider = Slider::new(&mut place, 0..=moments.len()).show_value(false);
    let response = ui.add(slider).labelled_by(label.id);
    if response.changed() && place != now {
        let moment = place.checked_sub(1).map_or(0, |at| moments[at].number);
        studio.act(Task::GoTo(moment));
    }
}

/// The keys of the step, which change from now on and not from the beginning.
fn settings(studio: &mut Studio, ui: &mut Ui, held: usize) {
    let Some(mut table) = studio.document.steps().get(held).map(|step| (*step).clone()) else { return };
    let Some(entry) = catalog::find(Document::word(&table)) else { return };
    for (key, value) in &studio.set {
        put(&mut table, key, value.clone());
    }
    let header = CollapsingHeader::new("Change while it runs");
    let shown = header.show(ui, |ui| {
        ui.label("From here on, as part of what was done by hand.");
        controls::controls(ui, &table, &(entry.parameters)(), "setting")
    });
    let Some(Turned { key, value: Some(text) }) = shown.body_returned.flatten() else { return };
    let Ok(parsed) = source::parse("", &format!("value = {text}")) else { return };
    let Some(node) = parsed.get("value") else { return };
    let value = node.value.clone();
    studio.set.retain(|(other, _)| *other != key);
    studio.set.push((key.clone(), value.clone()));
    studio.act(Task::Set(Setting { key, value }));
}

/// Sets a key of a table, also one within a table of it.
fn put(table: &mut source::Table, key: &str, value: Value) {
    match key.split_once('.') {
        None => table.set(key, source::Node { line: 0, value }),
        Some((outer, inner)) => {
            if table.get(outer).is_none() {
                table.set(outer, source::Node { line: 0, value: Value::Table(source::Table::default()) });
            }
            if let Some(source::Node { value: Value::Table(within), .. }) = table.get_mut(outer) {
                put(within, inner, value);
            }
        }
    }
}
