//! What the colours of a draped layer stand for, over a corner of the viewport.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2};
use weald::picture::{ColourScale, encode};

use crate::studio::Studio;

/// Size of the bar, in points, and its distance from the edges.
const BAR: Vec2 = Vec2::new(16.0, 180.0);
const MARGIN: f32 = 14.0;

/// Pieces that the bar is drawn in.
const PIECES: u16 = 90;

/// A colour of a scale as the window shows it.
pub(super) fn colour(scale: &ColourScale, share: f32) -> Color32 {
    let [red, green, blue] = encode(scale.ramp.at(share));
    Color32::from_rgb(red, green, blue)
}

pub(crate) fn show(studio: &Studio, painter: &Painter, rect: Rect) {
    let Some(shown) = &studio.status.shown else { return };
    let Some(drape) = studio.looks.drape(&shown.landscape) else { return };
    let (Ok(scale), Ok(layer)) = (drape.scale(&shown.landscape), shown.landscape.layer(&drape.of.0)) else {
        return;
    };
    let unit = if layer.unit == "1" { String::new() } else { format!(" in {}", layer.unit) };
    let title = format!("{}{unit}", drape.of.0);
    let font = FontId::proportional(12.0);
    let width = painter.layout_no_wrap(title.clone(), font.clone(), Color32::WHITE).size().x;
    let size = Vec2::new(width.max(90.0), BAR.y + 26.0) + Vec2::splat(16.0);
    let frame = Rect::from_min_size(rect.left_bottom() + Vec2::new(MARGIN, -MARGIN - size.y), size);
    painter.rect_filled(frame, 4.0, Color32::from_black_alpha(150));
    let inner = frame.shrink(8.0);
    painter.text(inner.min, Align2::LEFT_TOP, title, font.clone(), Color32::WHITE);
    let bar = Rect::from_min_size(inner.min + Vec2::new(0.0, 22.0), BAR);
    draw_bar(painter, bar, &scale);
    for (place, text) in scale.ticks() {
        let at = Pos2::new(bar.right(), bar.bottom() - place as f32 * bar.height());
        painter.line_segment([at, at + Vec2::new(4.0, 0.0)], Stroke::new(1.0, Color32::WHITE));
        painter.text(at + Vec2::new(7.0, 0.0), Align2::LEFT_CENTER, text, font.clone(), Color32::WHITE);
    }
}

fn draw_bar(painter: &Painter, bar: Rect, scale: &ColourScale) {
    let height = bar.height() / f32::from(PIECES);
    for piece in 0..PIECES {
        let top = bar.bottom() - f32::from(piece + 1) * height;
        let share = (f32::from(piece) + 0.5) / f32::from(PIECES);
        // Half a point more closes the gaps between pieces.
        let rect = Rect::from_min_size(Pos2::new(bar.left(), top), Vec2::new(bar.width(), height + 0.5));
        painter.rect_filled(rect, 0.0, colour(scale, share));
    }
}
