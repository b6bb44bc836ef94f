//! Light, colours and heights of the viewport, and layers draped over the ground.

use eframe::egui::{Checkbox, ComboBox, Slider, Ui};
use weald::picture::GroundColour;

use super::{cameras, histogram};
use crate::looks::RAMPS;
use crate::navigation::Mode;
use crate::studio::Studio;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.separator();
    ui.heading("Looks");
    let before = studio.looks.clone();
    ui.horizontal(|ui| {
        for (mode, name) in Mode::ALL {
            if ui.selectable_label(studio.mode == mode, name).clicked() {
                let context = ui.ctx().clone();
                studio.obey(crate::commands::Command::Camera(mode), &context);
            }
        }
    });
    let looks = &mut studio.looks;
    let slider = |ui: &mut Ui, name: &str, slider: Slider<'_>| {
        ui.horizontal(|ui| {
            let label = ui.label(name);
            ui.add(slider).labelled_by(label.id);
        });
    };
    slider(ui, "Time of day", Slider::new(&mut looks.hour, 6.0..=18.5).suffix(" h").fixed_decimals(1));
    slider(ui, "Height factor", Slider::new(&mut looks.exaggeration, 0.25..=4.0).logarithmic(true));
    slider(ui, "Exposure", Slider::new(&mut looks.exposure, -3.0..=3.0));
    let all = [
        (None, "as the recipe says"),
        (Some(GroundColour::Natural), "natural"),
        (Some(GroundColour::Materials), "materials"),
    ];
    let name = all.iter().find(|(ground, _)| *ground == looks.ground).map_or("", |(_, name)| name);
    ComboBox::from_label("Ground").selected_text(name).show_ui(ui, |ui| {
        for (ground, name) in all {
            ui.selectable_value(&mut looks.ground, ground, name);
        }
    });
    ui.add(Checkbox::new(&mut looks.water, "Draw water"));
    layers(studio, ui);
    if studio.looks != before {
        studio.looks_number += 1;
    }
    cameras::show(studio, ui);
}

/// The layer that is told under the pointer and colours the ground.
fn layers(studio: &mut Studio, ui: &mut Ui) {
    let Some(shown) = studio.status.shown.clone() else { return };
    let names: Vec<String> = shown.landscape.layers().map(|(name, _)| name.to_owned()).collect();
    let looks = &mut studio.looks;
    let chosen = looks.layer.clone().unwrap_or_else(|| "none".to_owned());
    ComboBox::from_label("Layer").selected_text(chosen).show_ui(ui, |ui| {
        ui.selectable_value(&mut looks.layer, None, "none");
        for name in names {
            ui.selectable_value(&mut looks.layer, Some(name.clone()), name);
        }
    });
    if looks.layer.is_none() {
        return;
    }
    ui.add(Checkbox::new(&mut looks.drapes, "Colour the ground by it"));
    if looks.drapes {
        ComboBox::from_label("Colours").selected_text(looks.ramp.word()).show_ui(ui, |ui| {
            for ramp in RAMPS {
                ui.selectable_value(&mut looks.ramp, ramp, ramp.word());
            }
        });
        ui.add(Checkbox::new(&mut looks.logarithmic, "By the logarithm"));
    }
    histogram::show(studio, ui);
}
