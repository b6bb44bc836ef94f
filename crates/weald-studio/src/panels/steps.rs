//! The recipe as a list of cards, a step each, whose controls are made from its declaration.

use eframe::egui::{self, CollapsingHeader, Frame, Key, RichText, ScrollArea, TextEdit, Ui};
use weald::recipe::LandscapeKeys;
use weald::recipe::catalog::{self, CATALOG};
use weald::recipe::parameter::Parameters;
use weald::recipe::source::Table;

use super::controls::{self, Turned};
use super::step_pictures;
use super::toolbar::button;
use crate::commands::Command;
use crate::document::Document;
use crate::studio::Studio;

/// What a button of a card does with its step.
#[derive(Clone, Copy)]
enum Move {
    Up,
    Down,
    Duplicate,
    Remove,
    Switch,
    Show,
    Rename,
}

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    ScrollArea::vertical().show(ui, |ui| {
        ui.heading("Recipe");
        diagnostics(studio, ui);
        landscape(studio, ui);
        let steps: Vec<Table> = studio.document.steps().into_iter().cloned().collect();
        for (at, step) in steps.iter().enumerate() {
            card(studio, ui, (at, steps.len()), step);
        }
        add(studio, ui);
        if button(ui, Command::Seeds).is_some() {
            let context = ui.ctx().clone();
            studio.obey(Command::Seeds, &context);
        }
    });
}

/// What is wrong, with the lines of the text.
pub(crate) fn diagnostics(studio: &Studio, ui: &mut Ui) {
    for diagnostic in studio.document.diagnostics() {
        let text = format!("line {}: {}", diagnostic.line, diagnostic.message);
        ui.label(RichText::new(text).color(ui.visuals().error_fg_color));
    }
}

fn landscape(studio: &mut Studio, ui: &mut Ui) {
    let table = studio.document.landscape();
    let header = CollapsingHeader::new("Landscape").default_open(true);
    let turned =
        header.show(ui, |ui| controls::controls(ui, &table, &LandscapeKeys::parameters(), "landscape"));
    if let Some(Turned { key, value }) = turned.body_returned.flatten() {
        let edited = studio.document.set_landscape_key(&key, value.as_deref());
        studio.edited(edited);
    }
}

fn card(studio: &mut Studio, ui: &mut Ui, (at, count): (usize, usize), step: &Table) {
    let word = Document::word(step).to_owned();
    let is_held = studio.status.held == Some(at);
    let is_shown = studio.selected == Some(at);
    Frame::group(ui.style()).show(ui, |ui| {
        ui.push_id(at, |ui| {
            let is_off = Document::is_off(step);
            let mut title = RichText::new(format!("{}. {word}", at + 1)).strong();
            if is_off {
                title = title.weak().strikethrough();
            }
            if is_held {
                title = title.color(ui.visuals().hyperlink_color);
            }
            let header = CollapsingHeader::new(title).id_salt("card").default_open(is_held);
            let entry = catalog::find(&word);
            let shown = header.show(ui, |ui| {
                let mut moved = None;
                let result = studio.document.result_of(at);
                ui.horizontal_wrapped(|ui| {
                    moved = buttons(ui, (at, count), (is_shown, is_off));
                    if let Some(result) = &result
                        && ui.small_button("Rename").on_hover_text(format!(
                            "Give {result}, which step {} makes, another name, here and in all that speaks of it",
                            at + 1
                        ))
                        .clicked()
                    {
                        moved = Some(Move::Rename);
                    }
                });
                renaming(studio, ui, at);
                let turned = entry.and_then(|entry| {
                    controls::controls(ui, step, &(entry.parameters)(), &format!("step {}", at + 1))
                });
                (moved, turned)
            });
            if let Some(entry) = entry {
                shown.header_response.on_hover_text(format!("{}\nAfter {}", entry.summary, entry.source));
            }
            let (moved, turned) = shown.body_returned.unwrap_or_default();
            if let Some(edited) = change(studio, at, moved, turned) {
                studio.edited(edited);
            }
        });
    });
}

fn buttons(ui: &mut Ui, (at, count): (usize, usize), (is_shown, is_off): (bool, bool)) -> Option<Move> {
    let mut moved = None;
    let mut button = |ui: &mut Ui, text: &str, hover: &str, is_on: bool, what: Move| {
        if ui.add_enabled(is_on, egui::Button::new(text).small()).on_hover_text(hover).clicked() {
            moved = Some(what);
        }
    };
    let number = at + 1;
    button(ui, "Up", &format!("Move step {number} up"), at > 0, Move::Up);
    button(ui, "Down", &format!("Move step {number} down"), at + 1 < count, Move::Down);
    button(ui, "Duplicate", &format!("Put a copy of step {number} after it"), true, Move::Duplicate);
    button(ui, "Remove", &format!("Take step {number} out"), true, Move::Remove);
    let switch = if is_off { "Switch on" } else { "Switch off" };
    button(
        ui,
        switch,
        &format!("Leave step {number} out without losing it, or run it again"),
        true,
        Move::Switch,
    );
    let show = if is_shown { "Show the end" } else { "Show here" };
    button(ui, show, "Show the landscape as it is after this step", true, Move::Show);
    moved
}

/// Changes the recipe as a card says; `None` where the recipe stays as it is.
fn change(
    studio: &mut Studio,
    at: usize,
    moved: Option<Move>,
    turned: Option<Turned>,
) -> Option<Result<(), String>> {
    Some(match moved {
        Some(Move::Up) => studio.document.move_step(at, at.saturating_sub(1)),
        Some(Move::Down) => studio.document.move_step(at, at + 1),
        Some(Move::Duplicate) => studio.document.duplicate_step(at),
        Some(Move::Remove) => studio.document.remove_step(at),
        Some(Move::Switch) => {
            let is_off = studio.document.steps().get(at).is_some_and(|step| Document::is_off(step));
            studio.document.set_step_key(at, "off", (!is_off).then_some("true"))
        }
        Some(Move::Rename) => {
            studio.renaming = studio.document.result_of(at).map(|name| (at, name));
            return None;
        }
        Some(Move::Show) => {
            studio.selected = (studio.selected != Some(at)).then_some(at);
            studio.run_again();
            return None;
        }
        None => {
            let Turned { key, value } = turned?;
            studio.document.set_step_key(at, &key, value.as_deref())
        }
    })
}

/// The field for another name of what a step makes, where that was asked for.
fn renaming(studio: &mut Studio, ui: &mut Ui, at: usize) {
    let Some((_, name)) = studio.renaming.as_mut().filter(|(step, _)| *step == at) else { return };
    let (mut renames, mut leaves) = (false, false);
    ui.horizontal(|ui| {
        let label = ui.label("New name");
        let field = ui.add(TextEdit::singleline(name).desired_width(140.0)).labelled_by(label.id);
        renames = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        renames |= ui.small_button("Give this name").clicked();
        leaves = ui.small_button("Leave it").clicked();
    });
    if renames {
        let name = name.trim().to_owned();
        studio.rename_result(at, &name);
    } else if leaves {
        studio.renaming = None;
    }
}

/// A list of all steps, found by what is typed.
fn add(studio: &mut Studio, ui: &mut Ui) {
    let mut chosen = None;
    ui.menu_button("Add a step …", |ui| {
        let label = ui.label("Find");
        ui.text_edit_singleline(&mut studio.search).labelled_by(label.id).request_focus();
        let wanted = studio.search.to_lowercase();
        ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
            for entry in CATALOG {
                let text = format!("{} {} {}", entry.name, entry.summary, entry.stage.title());
                if !text.to_lowercase().contains(&wanted) {
                    continue;
                }
                let hover = format!("{}\nAfter {}", entry.summary, entry.source);
                ui.horizontal(|ui| {
                    let pictured = step_pictures::show(ui, entry.name);
                    ui.vertical(|ui| {
                        if ui.button(entry.name).on_hover_text(hover).clicked() || pictured {
                            chosen = Some(entry.name);
                            ui.close();
                        }
                        ui.label(RichText::new(entry.summary).small().weak());
                    });
                });
            }
        });
    });
    if let Some(name) = chosen {
        studio.search.clear();
        let at = studio.document.steps().len();
        let edited = studio.document.add_step(name, at);
        studio.edited(edited);
    }
}
