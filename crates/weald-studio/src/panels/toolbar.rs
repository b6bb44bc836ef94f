//! The commands that one needs most, along the top.

use eframe::egui::Ui;

use crate::commands::{COMMANDS, Command};
use crate::studio::Studio;

/// The buttons, group by group.
const GROUPS: [&[Command]; 5] = [
    &[Command::New, Command::Open, Command::Save, Command::Export],
    &[Command::Undo, Command::Redo],
    &[Command::Frame, Command::TopView, Command::Turntable, Command::Picture],
    &[Command::Measure, Command::Pin],
    &[Command::Text, Command::Palette, Command::Theme, Command::Tour],
];

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    let (mut chosen, mut shares) = (None, false);
    ui.horizontal_wrapped(|ui| {
        for (place, group) in GROUPS.iter().enumerate() {
            if place > 0 {
                ui.separator();
            }
            for command in *group {
                chosen = button(ui, *command).or(chosen);
            }
        }
        if studio.is_hosted() {
            ui.separator();
            shares = ui
                .button("Share")
                .on_hover_text("makes a link of the recipe and of all that was done")
                .clicked();
        }
    });
    if shares {
        studio.share();
    }
    if let Some(command) = chosen {
        let context = ui.ctx().clone();
        studio.obey(command, &context);
    }
}

/// A button with the command's name, whose key and meaning show on hover.
pub(crate) fn button(ui: &mut Ui, command: Command) -> Option<Command> {
    let entry = COMMANDS.iter().find(|entry| entry.command == command)?;
    let response = ui.button(entry.name).on_hover_text(format!("{}\n{}", entry.what, entry.keys.in_words()));
    response.clicked().then_some(command)
}
