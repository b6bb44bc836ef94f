//! What lies over the picture of the landscape: the ring of the brush, the line that is measured, the bar between two
//! moments, the legend, and what went wrong.

use eframe::egui::{Align2, Color32, CursorIcon, FontId, Id, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2};

use super::legend;
use crate::pick::Place;
use crate::studio::Studio;

/// Points of the ring that shows the brush on the ground, and of a line over it.
const RING: usize = 48;
const LINE: usize = 96;

/// Half the width, in points, in which the bar between two moments can be taken.
const GRIP: f32 = 8.0;

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui, rect: Rect) {
    bar(studio, ui, rect);
    let painter = ui.painter().with_clip_rect(rect);
    legend::show(studio, &painter, rect);
    if let Some(line) = studio.measuring.line {
        measured(studio, &painter, rect, line);
    }
    if let Some(stroke) = studio.stroke.as_ref().filter(|stroke| stroke.density().is_some()) {
        // What grows follows when the stroke ends; until then its line is seen.
        let points = stroke.path().iter().filter_map(|at| on_screen(studio, rect, top_at(studio, *at)?));
        outlined(&painter, points.collect(), 2.0);
    }
    if let Some(place) = studio.pointed.filter(|_| studio.paints()) {
        ring(studio, &painter, rect, place);
    }
    let error = studio.viewport.as_ref().and_then(|viewport| viewport.error());
    let has_picture = studio.viewport.as_ref().is_none_or(|viewport| viewport.texture().is_some());
    let text = match (&studio.status.shown, error) {
        (_, Some(error)) => error,
        (None, None) => "The landscape is being made …".to_owned(),
        (Some(_), None) if !has_picture => "Its picture is being made …".to_owned(),
        _ => return,
    };
    let colour = ui.visuals().text_color();
    painter.text(rect.center(), Align2::CENTER_CENTER, text, FontId::proportional(15.0), colour);
}

/// The bar between what is pinned, on its left, and what is shown.
fn bar(studio: &mut Studio, ui: &mut Ui, rect: Rect) {
    if studio.viewport.as_ref().and_then(|viewport| viewport.pinned_texture()).is_none() {
        return;
    }
    let at = rect.left() + studio.wipe * rect.width();
    let grip = Rect::from_center_size(Pos2::new(at, rect.center().y), Vec2::new(2.0 * GRIP, rect.height()));
    let response =
        ui.interact(grip, Id::unique("wipe"), Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label("Bar between two moments"));
    studio.wipe = (studio.wipe + response.drag_delta().x / rect.width()).clamp(0.0, 1.0);
    let width = if response.hovered() || response.dragged() { 4.0 } else { 2.0 };
    ui.painter().vline(at, rect.y_range(), Stroke::new(width, Color32::WHITE));
}

/// The line that is measured as it lies on the ground, with its ends.
fn measured(studio: &Studio, painter: &Painter, rect: Rect, [from, to]: [[f64; 2]; 2]) {
    let points: Vec<_> = (0..=LINE)
        .filter_map(|step| {
            let share = step as f64 / LINE as f64;
            let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            on_screen(studio, rect, top_at(studio, at)?)
        })
        .collect();
    for end in [points.first(), points.last()].into_iter().flatten() {
        painter.circle(*end, 4.0, Color32::WHITE, Stroke::new(1.5, Color32::BLACK));
    }
    outlined(painter, points, 2.0);
}

/// The edge of the brush as it lies on the ground, and where it has half its strength.
fn ring(studio: &Studio, painter: &Painter, rect: Rect, place: Place) {
    for (share, width) in [(1.0, 2.0), (0.5, 1.0)] {
        let points = (0..=RING).filter_map(|step| {
            let (sine, cosine) = (std::f64::consts::TAU * step as f64 / RING as f64).sin_cos();
            let radius = share * studio.brush.radius;
            let at = [place.at[0] + radius * cosine, place.at[1] + radius * sine];
            on_screen(studio, rect, top_at(studio, at)?)
        });
        outlined(painter, points.collect(), width);
    }
}

/// A white line that can be seen on any ground.
fn outlined(painter: &Painter, points: Vec<Pos2>, width: f32) {
    painter.line(points.clone(), Stroke::new(width + 1.5, Color32::from_black_alpha(140)));
    painter.line(points, Stroke::new(width, Color32::WHITE));
}

/// The ground, or the water on it.
pub(super) fn top_at(studio: &Studio, at: [f64; 2]) -> Option<Place> {
    let place = studio.target()?.at(at)?;
    Some(Place { ground: place.ground + place.water, ..place })
}

pub(super) fn on_screen(studio: &Studio, rect: Rect, place: Place) -> Option<Pos2> {
    let (camera, point) = (studio.camera?, studio.point(place)?);
    let from: [f32; 3] = std::array::from_fn(|axis| point[axis] - camera.eye[axis]);
    let dot = |axis: [f32; 3]| from[0] * axis[0] + from[1] * axis[1] + from[2] * axis[2];
    let depth = dot(camera.forward);
    if depth <= 0.0 {
        return None;
    }
    let across = dot(camera.right) / depth / camera.half[0];
    let up = dot(camera.up) / depth / camera.half[1];
    Some(rect.center() + 0.5 * Vec2::new(across * rect.width(), -up * rect.height()))
}
