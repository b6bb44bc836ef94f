//! The painted mask, as a tint on the ground that it protects.

use eframe::egui::{Color32, Mesh, Pos2, Rect, Shape, Ui};
use weald::edit::Canvas;

use super::overlay::{on_screen, top_at};
use crate::studio::Studio;

/// Most pieces of the tint along a side: finer would not be seen.
const PIECES: usize = 96;

/// The tint where the mask is whole, as red, green, blue and opacity.
const TINT: [u8; 4] = [214, 64, 48, 150];

/// Draws the mask over the picture of the land, where there is one.
pub(crate) fn show(studio: &Studio, ui: &Ui, rect: Rect) {
    let Some(surface) = studio.surface() else { return };
    let canvas = &surface.canvas;
    if canvas.mask.values().iter().all(|value| *value == 0.0) {
        return;
    }
    let size = canvas.size();
    let pieces = [size.columns, size.rows].map(|cells| cells.min(PIECES));
    let corner = |x: usize, y: usize| {
        let [column, row] = [x * (size.columns - 1) / pieces[0], y * (size.rows - 1) / pieces[1]];
        let share = canvas.mask.at(column, row);
        let place = top_at(studio, centre(canvas, [column, row]))?;
        Some((on_screen(studio, rect, place)?, share))
    };
    let corners: Vec<_> = (0..=pieces[1])
        .flat_map(|y| (0..=pieces[0]).map(move |x| (x, y)))
        .map(|(x, y)| corner(x, y))
        .collect();
    let mut mesh = Mesh::default();
    for y in 0..pieces[1] {
        for x in 0..pieces[0] {
            let at = |x: usize, y: usize| corners[y * (pieces[0] + 1) + x];
            // Round the piece, so that ground that faces away shows by its turn.
            if let [Some(a), Some(b), Some(c), Some(d)] =
                [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]
            {
                piece(&mut mesh, [a, b, c, d]);
            }
        }
    }
    ui.painter().with_clip_rect(rect).add(Shape::mesh(mesh));
}

/// Metres east and south of the middle of a cell.
fn centre(canvas: &Canvas, cell: [usize; 2]) -> [f64; 2] {
    cell.map(|place| (place as f64 + 0.5) * canvas.cell)
}

/// Adds a piece that is masked and faces the camera.
fn piece(mesh: &mut Mesh, corners: [(Pos2, f32); 4]) {
    let [a, b, c, _] = corners.map(|(at, _)| at);
    let is_masked = corners.iter().any(|(_, share)| *share > 0.0);
    let turn = (b - a).x * (c - a).y - (b - a).y * (c - a).x;
    if !is_masked || turn <= 0.0 {
        return;
    }
    let first = mesh.vertices.len() as u32;
    for (at, share) in corners {
        let [red, green, blue, opacity] = TINT;
        let opacity = (f32::from(opacity) * share) as u8;
        mesh.colored_vertex(at, Color32::from_rgba_unmultiplied(red, green, blue, opacity));
    }
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first, first + 2, first + 3);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_tinted_where_it_is_masked_and_faces_the_camera() {
        let corners = |shares: [f32; 4]| {
            [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]
                .map(Pos2::from)
                .into_iter()
                .zip(shares)
                .collect::<Vec<_>>()
        };
        let drawn = |corners: Vec<(Pos2, f32)>| {
            let mut mesh = Mesh::default();
            piece(&mut mesh, corners.try_into().expect("four"));
            mesh
        };
        assert!(drawn(corners([0.0; 4])).is_empty());
        let mesh = drawn(corners([1.0, 0.5, 0.0, 0.0]));
        assert_eq!(mesh.indices.len(), 6);
        let opacities: Vec<_> = mesh.vertices.iter().map(|vertex| vertex.color.a()).collect();
        assert_eq!(opacities, [150, 75, 0, 0]);
        let away = corners([1.0; 4]).into_iter().rev().collect();
        assert!(drawn(away).is_empty(), "the back of a hill");
    }
}
