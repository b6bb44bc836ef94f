//! The brushes: which one, how wide, how strong, and of what.

use eframe::egui::{ComboBox, DragValue, Slider, Ui};
use weald::edit::Falloff;

use crate::brushes::{Settings, Tool};
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
    let (brush, materials) = (&mut studio.brush, &studio.status.materials);
    if !materials.contains(&brush.material)
        && let Some(last) = materials.last()
    {
        // What settles is the last material.
        brush.material.clone_from(last);
    }
    slider(ui, "Radius", Slider::new(&mut brush.radius, 0.1..=100_000.0).logarithmic(true).suffix(" m"));
    slider(ui, "Strength", Slider::new(&mut brush.strength, 0.01..=1.0));
    falloff(ui, brush);
    amount(ui, brush, materials);
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
            ComboBox::from_label("Material").selected_text(&brush.material).show_ui(ui, |ui| {
                for name in materials {
                    ui.selectable_value(&mut brush.material, name.clone(), name);
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
        Tool::None | Tool::Smooth | Tool::Level | Tool::Freeze | Tool::Thaw => {}
    }
}
