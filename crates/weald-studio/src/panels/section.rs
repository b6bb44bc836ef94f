//! The section along the line that was drawn: its profile, and distance, rise and slope.

use eframe::egui::{Align2, Color32, Rect, Ui, Vec2, Window};
use egui_plot::{Corner, FilledArea, Legend, Line, Plot};

use crate::section::{Sample, measures, section};
use crate::studio::Studio;

const GROUND: Color32 = Color32::from_rgb(0xc9, 0x9a, 0x5b);
const WATER: Color32 = Color32::from_rgb(0x4a, 0x8f, 0xc4);
const BEDROCK: Color32 = Color32::from_rgb(0x8a, 0x8a, 0x90);

/// Distance of the window from the corner of the viewport, in points.
const MARGIN: Vec2 = Vec2::new(12.0, -12.0);

/// Stands in the lower left corner of the viewport, until it is moved.
pub(crate) fn show(studio: &mut Studio, ui: &Ui, viewport: Rect) {
    let Some(line) = studio.measuring.line else { return };
    let Some(samples) = samples(studio, line) else { return };
    let mut is_open = true;
    let window = Window::new("Section").default_width(420.0).default_height(240.0);
    let window = window.pivot(Align2::LEFT_BOTTOM).default_pos(viewport.left_bottom() + MARGIN);
    window.open(&mut is_open).show(ui.ctx(), |ui| {
        let Some(measured) = measures(&samples) else {
            ui.label("Drag over the landscape to draw a line.");
            return;
        };
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("Distance {:.1} m", measured.distance));
            ui.label(format!("over the ground {:.1} m", measured.path));
            ui.label(format!("rise {:+.1} m", measured.rise));
            ui.label(format!(
                "slope {:.1}°, steepest {:.1}°",
                measured.mean_slope_deg, measured.steepest_deg
            ));
        });
        profile(ui, &samples);
    });
    if !is_open {
        studio.measuring.line = None;
    }
}

/// The ground along a line as it is now.
fn samples(studio: &Studio, line: [[f64; 2]; 2]) -> Option<Vec<Sample>> {
    let target = studio.target()?;
    let surface = studio.surface();
    let shown = studio.status.shown.as_ref()?;
    let bedrock =
        surface.map(|surface| &surface.canvas.bedrock).or_else(|| shown.landscape.field("bedrock").ok());
    Some(section(&target, bedrock, line))
}

fn profile(ui: &mut Ui, samples: &[Sample]) {
    let points = |value: &dyn Fn(&Sample) -> Option<f64>| -> Vec<[f64; 2]> {
        samples.iter().filter_map(|sample| Some([sample.along, value(sample)?])).collect()
    };
    let ground = points(&|sample| Some(sample.ground));
    let bedrock = points(&|sample| sample.bedrock);
    let along: Vec<f64> = samples.iter().map(|sample| sample.along).collect();
    let below: Vec<f64> = samples.iter().map(|sample| sample.ground).collect();
    let level: Vec<f64> = samples.iter().map(|sample| sample.ground + sample.water).collect();
    Plot::new("profile")
        .height(ui.available_height().max(160.0))
        .x_axis_label("metres along the line")
        .y_axis_label("elevation in metres")
        .legend(Legend::default().position(Corner::RightTop))
        .allow_scroll(false)
        .show(ui, |plot| {
            if samples.iter().any(|sample| sample.water > 0.0) {
                plot.add(FilledArea::new("water", &along, &below, &level).fill_color(WATER));
            }
            if !bedrock.is_empty() {
                plot.line(Line::new("bedrock", bedrock).color(BEDROCK).width(1.5));
            }
            plot.line(Line::new("ground", ground).color(GROUND).width(2.0));
        });
}
