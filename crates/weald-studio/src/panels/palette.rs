//! The palette: any command by a part of its name.

use eframe::egui::{Id, Key, Modal, RichText, ScrollArea, Ui};

use crate::commands::{COMMANDS, Entry};
use crate::studio::Studio;

pub(crate) fn show(studio: &mut Studio, ui: &Ui) {
    let Some(mut palette) = studio.palette.take() else { return };
    let mut run = None;
    let modal = Modal::new(Id::unique("palette")).show(ui.ctx(), |ui| {
        ui.set_width(420.0);
        ui.heading("Commands");
        let label = ui.label("Find");
        let response = ui.text_edit_singleline(&mut palette.wanted).labelled_by(label.id);
        response.request_focus();
        if response.changed() {
            palette.chosen = 0;
        }
        let found = found(&palette.wanted);
        let (down, up, enter) = ui.input(|input| {
            (
                input.key_pressed(Key::ArrowDown),
                input.key_pressed(Key::ArrowUp),
                input.key_pressed(Key::Enter),
            )
        });
        palette.chosen = (palette.chosen + usize::from(down))
            .saturating_sub(usize::from(up))
            .min(found.len().saturating_sub(1));
        ScrollArea::vertical().max_height(360.0).show(ui, |ui| {
            for (place, entry) in found.iter().enumerate() {
                let response = ui.selectable_label(
                    place == palette.chosen,
                    format!("{}  {}", entry.name, entry.keys.in_words()),
                );
                ui.label(RichText::new(entry.what).small().weak());
                if response.clicked() || (enter && place == palette.chosen) {
                    run = Some(entry.command);
                }
            }
        });
    });
    if let Some(command) = run {
        let context = ui.ctx().clone();
        studio.obey(command, &context);
    } else if !modal.should_close() {
        studio.palette = Some(palette);
    }
}

/// The commands whose name or meaning has all the words.
fn found(wanted: &str) -> Vec<&'static Entry> {
    let words: Vec<_> = wanted.to_lowercase().split_whitespace().map(str::to_owned).collect();
    let has = |entry: &&Entry| {
        let text = format!("{} {}", entry.name, entry.what).to_lowercase();
        words.iter().all(|word| text.contains(word))
    };
    COMMANDS.iter().filter(has).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::Command;

    #[test]
    fn a_command_is_found_by_parts_of_its_name_and_meaning() {
        assert_eq!(found("").len(), COMMANDS.len());
        assert_eq!(found("brush wat")[0].command, Command::Brush(crate::brushes::Tool::Water));
        assert!(found("no such thing").is_empty());
    }
}
