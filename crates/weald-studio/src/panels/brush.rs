//! The brushes: which one, how wide, how strong, and of what.

use eframe::egui::{ComboBox, DragValue, Slider, Ui};
use weald::edit::Falloff;

use crate::brushes::{Pen, Settings, Tool};
use crate::commands::Command;
use crate::studio::Studio;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.separator();
    ui.heading("Brush");
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for (tool, name, what) in Tool::ALL {
            let is_on = studio.brush.tool == tool;
            if ui.selectable_label(is_on, name).on_hover_text(what).clicked() {
                chosen = Some(if is_on { Tool::None } else { tool });
            }
        }
    });
    if let Some(tool) = chosen {
        let context = ui.ctx().clone();
        studio.obey(Command::Brush(tool), &context);
    }
    if studio.brush.tool.density().is_some() {
        plants(studio, ui);
    }
    let (brush, materials) = (&mut studio.brush, &studio.status.materials);
    slider(ui, "Radius", Slider::new(&mut brush.radius, 0.1..=100_000.0).logarithmic(true).suffix(" m"));
    slider(ui, "Strength", Slider::new(&mut brush.strength, 0.01..=1.0));
    falloff(ui, brush);
    pen(ui, brush);
    amount(ui, brush, materials);
}

/// The steps that grow plants, of which the brush is about one.
fn plants(studio: &mut Studio, ui: &mut Ui) {
    let growing = studio.document.growing();
    let Some((_, name)) = growing.get(studio.brush.plants).or_else(|| growing.first()) else { return };
    ComboBox::from_label("Plants").selected_text(name).show_ui(ui, |ui| {
        for (place, (_, name)) in growing.iter().enumerate() {
            ui.selectable_value(&mut studio.brush.plants, place, name);
        }
    });
}

fn slider(ui: &mut Ui, name: &str, slider: Slider<'_>) {
    ui.horizontal(|ui| {
        let label = ui.label(name);
        ui.add(slider).labelled_by(label.id);
    });
}

fn falloff(ui: &mut Ui, brush: &mut Settings) {
    let all = [
        (Falloff::Hard, "hard"),
        (Falloff::Linear, "linear"),
        (Falloff::Smooth, "smooth"),
        (Falloff::Gaussian, "gaussian"),
    ];
    let name = all.iter().find(|(falloff, _)| *falloff == brush.falloff).map_or("", |(_, name)| name);
    ComboBox::from_label("Falloff").selected_text(name).show_ui(ui, |ui| {
        for (falloff, name) in all {
            ui.selectable_value(&mut brush.falloff, falloff, name);
        }
    });
}

fn pen(ui: &mut Ui, brush: &mut Settings) {
    let name = Pen::ALL.iter().find(|(pen, _)| *pen == brush.pen).map_or("", |(_, name)| name);
    ComboBox::from_label("Pen pressure").selected_text(name).show_ui(ui, |ui| {
        for (pen, name) in Pen::ALL {
            ui.selectable_value(&mut brush.pen, pen, name);
        }
    });
}

/// How much of what, as the tool asks.
fn amount(ui: &mut Ui, brush: &mut Settings, materials: &[String]) {
    let number = |ui: &mut Ui,
                  name: &str,
                  value: &mut f64,
                  (range, speed, unit): (std::ops::RangeInclusive<f64>, f64, &str)| {
        ui.horizontal(|ui| {
            let label = ui.label(name);
            ui.add(DragValue::new(value).range(range).speed(speed).suffix(unit)).labelled_by(label.id);
        });
    };
    match brush.tool {
        Tool::Add | Tool::Remove => {
            let chosen = brush.material_of(materials).to_owned();
            ComboBox::from_label("Material").selected_text(&chosen).show_ui(ui, |ui| {
                for name in materials {
                    if ui.selectable_label(*name == chosen, name).clicked() {
                        brush.material.clone_from(name);
                    }
                }
            });
            number(ui, "Thickness", &mut brush.thickness, (0.0..=10_000.0, 0.1, " m"));
        }
        Tool::Water | Tool::Dry => number(ui, "Depth", &mut brush.depth, (0.0..=10_000.0, 0.1, " m")),
        Tool::Flatten => number(ui, "Elevation", &mut brush.height, (-20_000.0..=20_000.0, 1.0, " m")),
        Tool::Spring | Tool::Drain => {
            number(ui, "Depth a step", &mut brush.rate, (0.0..=1_000.0, 0.001, " m"));
        }
        Tool::Rain => number(ui, "Factor on the rain", &mut brush.factor, (0.0..=1_000.0, 0.1, "")),
        Tool::None
        | Tool::Smooth
        | Tool::Level
        | Tool::Freeze
        | Tool::Thaw
        | Tool::Mask
        | Tool::Unmask
        | Tool::Plant
        | Tool::Clear => {}
    }
}
