//! What an export writes, and what is lost in it, before it is written.

use eframe::egui::{ComboBox, RichText, ScrollArea, Ui};

use crate::presets::{self, Outputs, PRESETS};
use crate::studio::Studio;

/// What the outputs of the recipe itself are called.
const OF_RECIPE: &str = "as the recipe says";

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    let chosen = studio.exporting.preset.map_or(OF_RECIPE, |at| PRESETS[at].name);
    ComboBox::from_label("Preset").selected_text(chosen).show_ui(ui, |ui| {
        ui.selectable_value(&mut studio.exporting.preset, None, OF_RECIPE);
        for (at, preset) in PRESETS.iter().enumerate() {
            ui.selectable_value(&mut studio.exporting.preset, Some(at), preset.name)
                .on_hover_text(preset.what);
        }
    });
    match outputs(studio) {
        Ok(outputs) => list(ui, &outputs),
        Err(reason) => {
            ui.label(RichText::new(reason).color(ui.visuals().error_fg_color));
        }
    }
}

fn list(ui: &mut Ui, Outputs { files, left_out, .. }: &Outputs) {
    ScrollArea::vertical().max_height(220.0).min_scrolled_height(220.0).show(ui, |ui| {
        for (file, said) in files {
            ui.label(RichText::new(file).strong());
            ui.label(RichText::new(said).small());
        }
        if !left_out.is_empty() {
            ui.collapsing(format!("Not of this recipe ({})", left_out.len()), |ui| {
                for one in left_out {
                    ui.label(RichText::new(one).small());
                }
            });
        }
    });
}

/// What is written, which is worked out anew where the text or the preset is another.
fn outputs(studio: &mut Studio) -> Result<Outputs, String> {
    let key = (studio.document.revision(), studio.exporting.preset);
    if let Some((_, known)) = studio.exporting.known.as_ref().filter(|(of, _)| *of == key) {
        return known.clone();
    }
    let of = (studio.document.file(), studio.document.text());
    let shown = studio.status.shown.as_ref().map(|shown| &*shown.landscape);
    let outputs = match studio.exporting.preset {
        Some(at) => PRESETS[at].outputs(of, shown),
        None => presets::of_recipe(of, shown),
    };
    studio.exporting.known = Some((key, outputs.clone()));
    outputs
}

/// The outputs in place of those of the recipe, where a preset is chosen.
pub(super) fn chosen(studio: &mut Studio) -> Option<String> {
    studio.exporting.preset?;
    outputs(studio).ok().map(|outputs| outputs.text)
}
