//! Where the panels are: around the landscape, or on a narrow screen below it, one at a time.

use eframe::egui::{Panel, ScrollArea, Ui};

use super::toolbar::{self, button};
use super::{brush, history, looks, simulation, status, steps, text};
use crate::commands::Command;
use crate::studio::{Left, Part, Studio};

/// Width, in points, below which panels at the sides would leave nothing of the landscape.
const NARROW: f32 = 760.0;

/// Share of the height that a panel has on a narrow screen.
const SHARE: f32 = 0.42;

/// Shows all panels; what is left is the landscape's.
pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    if ui.available_width() < NARROW {
        return below(studio, ui);
    }
    Panel::top("toolbar").show(ui, |ui| toolbar::show(studio, ui));
    Panel::bottom("status").show(ui, |ui| status::show(studio, ui));
    Panel::left("recipe").default_size(340.0).show(ui, |ui| recipe(studio, ui));
    Panel::right("simulation").default_size(280.0).show(ui, |ui| tools(studio, ui));
}

fn below(studio: &mut Studio, ui: &mut Ui) {
    Panel::top("toolbar").show(ui, |ui| short_toolbar(studio, ui));
    Panel::bottom("status").show(ui, |ui| status::show(studio, ui));
    let Some(part) = studio.part else { return };
    let height = SHARE * ui.available_height();
    Panel::bottom("part").exact_size(height).show(ui, |ui| match part {
        Part::Recipe => recipe(studio, ui),
        Part::Simulation => tools(studio, ui),
    });
}

/// The commands that one needs most, and what is shown below; the palette has the rest.
fn short_toolbar(studio: &mut Studio, ui: &mut Ui) {
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for (part, name) in [(Part::Recipe, "Recipe"), (Part::Simulation, "Simulation")] {
            let is_shown = studio.part == Some(part);
            if ui.selectable_label(is_shown, name).clicked() {
                studio.part = (!is_shown).then_some(part);
            }
        }
        for command in [Command::Play, Command::Undo, Command::Redo, Command::Palette] {
            chosen = button(ui, command).or(chosen);
        }
    });
    if let Some(command) = chosen {
        let context = ui.ctx().clone();
        studio.obey(command, &context);
    }
}

fn recipe(studio: &mut Studio, ui: &mut Ui) {
    match studio.left {
        Left::Cards => steps::show(studio, ui),
        Left::Text => text::show(studio, ui),
    }
}

fn tools(studio: &mut Studio, ui: &mut Ui) {
    ScrollArea::vertical().show(ui, |ui| {
        simulation::show(studio, ui);
        brush::show(studio, ui);
        looks::show(studio, ui);
        history::show(studio, ui);
    });
}
