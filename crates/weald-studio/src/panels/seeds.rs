//! Landscapes of several seeds on a sheet, of which one is chosen.

use std::path::{Path, PathBuf};

use eframe::egui::{
    Button, ColorImage, DragValue, Id, Image, ImageSource, Modal, ProgressBar, ScrollArea, Sense, TextEdit,
    TextureHandle, TextureOptions, Ui, Vec2,
};
use weald::files;

use super::pictures;
use crate::studio::{Sheet, Studio};
use crate::work::{Seeds, Task};

/// Most seeds of a sheet.
const MAX_SEEDS: u64 = 64;

/// Side of a picture, in points.
const SIDE: f32 = 128.0;

/// What was chosen on the sheet.
enum Choice {
    Begin,
    End,
    Take(u64),
    Close,
}

pub(crate) fn show(studio: &mut Studio, ui: &Ui) {
    let Some(mut sheet) = studio.sheet.take() else { return };
    let mut choice = None;
    let modal = Modal::new(Id::unique("seeds")).show(ui.ctx(), |ui| {
        ui.set_width(600.0);
        ui.heading("One recipe, many seeds");
        let runs = studio.status.seeds.as_ref().is_some_and(|seeds| seeds.runs);
        ui.add_enabled_ui(!runs, |ui| wishes(ui, &mut sheet));
        ui.horizontal(|ui| {
            if ui.add_enabled(!runs, Button::new("Make them")).clicked() {
                choice = Some(Choice::Begin);
            }
            if ui.add_enabled(runs, Button::new("Stop")).clicked() {
                choice = Some(Choice::End);
            }
            if ui.button("Close").clicked() {
                choice = Some(Choice::Close);
            }
        });
        if let Some(seeds) = &studio.status.seeds {
            choice = made(ui, seeds).map(Choice::Take).or(choice.take());
        }
    });
    let closes = modal.should_close();
    match choice {
        Some(Choice::Begin) => {
            let Sheet { first, count, folder } = &sheet;
            let (folder, first, count) = (PathBuf::from(folder.trim()), *first, *count);
            studio.work.ask(Task::Seeds { folder, first, count });
        }
        Some(Choice::End) => studio.work.ask(Task::EndSeeds),
        Some(Choice::Take(seed)) => {
            studio.work.ask(Task::EndSeeds);
            let edited = studio.document.set_landscape_key("seed", Some(&seed.to_string()));
            studio.edited(edited);
            return;
        }
        Some(Choice::Close) => return,
        None if closes => return,
        None => {}
    }
    studio.sheet = Some(sheet);
}

fn wishes(ui: &mut Ui, sheet: &mut Sheet) {
    let number = |ui: &mut Ui, name: &str, value: &mut u64, most: u64| {
        let label = ui.label(name);
        ui.add(DragValue::new(value).range(u64::from(most == MAX_SEEDS)..=most)).labelled_by(label.id);
    };
    ui.horizontal(|ui| {
        number(ui, "First seed", &mut sheet.first, i64::MAX as u64);
        number(ui, "Seeds", &mut sheet.count, MAX_SEEDS);
    });
    ui.horizontal(|ui| {
        let label = ui.label("Pictures into");
        ui.add(TextEdit::singleline(&mut sheet.folder).desired_width(f32::INFINITY)).labelled_by(label.id);
    });
}

/// How far it is, and the pictures; gives the seed of one that was clicked.
fn made(ui: &mut Ui, seeds: &Seeds) -> Option<u64> {
    let (done, count) = (seeds.done.len(), seeds.count.max(1));
    ui.add(ProgressBar::new(done as f32 / count as f32).text(format!("{done} of {count} seeds")));
    if let Some(sheet) = &seeds.sheet {
        ui.label(format!("All of them are on {}", sheet.display()));
    }
    let mut chosen = None;
    ScrollArea::vertical().max_height(420.0).min_scrolled_height(420.0).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            for (seed, picture) in &seeds.done {
                ui.vertical(|ui| match picture {
                    Ok(file) => {
                        let is_taken = thumbnail(ui, (seeds.number, *seed), file);
                        if ui.button(format!("Take seed {seed}")).clicked() || is_taken {
                            chosen = Some(*seed);
                        }
                    }
                    Err(reason) => {
                        ui.label(format!("seed {seed}: {reason}"));
                    }
                });
            }
        });
    });
    chosen
}

/// Shows a picture; `true` where it was clicked.
fn thumbnail(ui: &mut Ui, (number, seed): (u64, u64), file: &Path) -> bool {
    let id = Id::unique(("seed", number, file));
    let kept = ui.data(|data| data.get_temp::<TextureHandle>(id));
    let texture = kept.or_else(|| {
        let image: ColorImage = pictures::decoded(&files::read(file).ok()?)?;
        let texture = ui.ctx().load_texture(file.display().to_string(), image, TextureOptions::LINEAR);
        ui.data_mut(|data| data.insert_temp(id, texture.clone()));
        Some(texture)
    });
    let Some(texture) = texture else { return false };
    let [width, height] = texture.size().map(|side| side as f32);
    let size = Vec2::new(width, height) * (SIDE / width.max(height));
    let source = ImageSource::Texture((texture.id(), size).into());
    let image = Image::new(source).alt_text(format!("picture of seed {seed}")).sense(Sense::click());
    ui.add(image).on_hover_text("Go on with this seed").clicked()
}
