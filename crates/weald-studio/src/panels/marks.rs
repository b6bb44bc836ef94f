//! Marks of the springs and drains that the recipe has, over the picture: one that is dragged lets its water rise elsewhere.

use eframe::egui::{Align2, Color32, CursorIcon, FontId, Id, Pos2, Rect, Sense, Stroke, Ui, Vec2};
use weald::recipe::source::{Node, Table, Value};

use super::controls::toml;
use super::overlay::{on_screen, top_at};
use crate::brushes::Tool;
use crate::studio::Studio;

/// Half the width of a mark, in points.
const HALF: f32 = 9.0;

/// Keys of a step that have places, what one of them is called, its letter and its colour.
const KINDS: [(&str, &str, &str, Color32); 2] = [
    ("sources", "Spring", "S", Color32::from_rgb(0x2f, 0x7f, 0xd0)),
    ("drains", "Drain", "D", Color32::from_rgb(0x80, 0x50, 0x30)),
];

/// A mark that is being moved, and where it is now, in metres east and south.
#[derive(Clone, Copy, Debug)]
struct Moved {
    kind: usize,
    place: usize,
    at: [f64; 2],
}

pub(crate) fn show(studio: &mut Studio, ui: &mut Ui, rect: Rect) {
    let Some(held) = studio.status.held else { return };
    let Some(step) = studio.document.steps().get(held).map(|step| (*step).clone()) else { return };
    for (kind, (key, ..)) in KINDS.iter().enumerate() {
        let Some(places) = places(&step, key) else { continue };
        for (place, at) in places.into_iter().enumerate() {
            let dropped = mark(studio, ui, rect, Moved { kind, place, at });
            if let Some(text) = dropped.and_then(|at| moved(&step, key, place, at)) {
                let edited = studio.document.set_step_key(held, key, Some(&text));
                studio.edited(edited);
                return;
            }
        }
    }
}

/// Shows a mark, and gives the place where it was let go, where it was.
fn mark(studio: &Studio, ui: &mut Ui, rect: Rect, of: Moved) -> Option<[f64; 2]> {
    let (_, name, letter, colour) = KINDS[of.kind];
    let (id, kept) = (Id::unique(("mark", of.kind, of.place)), Id::unique("moved mark"));
    let moved: Option<Moved> = ui.data(|data| data.get_temp(kept));
    let moved = moved.filter(|moved| (moved.kind, moved.place) == (of.kind, of.place));
    let centre = on_screen(studio, rect, top_at(studio, moved.unwrap_or(of).at)?)?;
    if !rect.contains(centre) {
        return None;
    }
    let is_free = studio.brush.tool == Tool::None && !studio.measuring.is_on;
    let sense = if is_free { Sense::drag() } else { Sense::hover() };
    let response = ui.interact(Rect::from_center_size(centre, Vec2::splat(2.0 * HALF)), id, sense);
    let label = format!("{name} {}", of.place + 1);
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(label.as_str()));
    draw(ui, centre, (letter, colour), response.hovered() || response.dragged());
    let response = response
        .on_hover_cursor(CursorIcon::Grab)
        .on_hover_text(format!("{label} of the recipe. Drag it to move it; what comes after it runs again."));
    let under = response.interact_pointer_pos().and_then(|at| studio.under_pointer(rect, at));
    if response.dragged()
        && let Some(place) = under
    {
        ui.data_mut(|data| data.insert_temp(kept, Moved { at: place.at, ..of }));
    }
    if response.drag_stopped() {
        ui.data_mut(|data| data.remove::<Moved>(kept));
        return moved.map(|moved| moved.at);
    }
    None
}

fn draw(ui: &Ui, centre: Pos2, (letter, colour): (&str, Color32), is_lively: bool) {
    let half = if is_lively { HALF + 2.0 } else { HALF };
    ui.painter().circle(centre, half, colour, Stroke::new(2.0, Color32::WHITE));
    ui.painter().text(centre, Align2::CENTER_CENTER, letter, FontId::proportional(12.0), Color32::WHITE);
}

/// The tables of a key that is a list of them.
fn tables<'a>(step: &'a Table, key: &str) -> Option<Vec<&'a Table>> {
    let Some(Node { value: Value::List(items), .. }) = step.get(key) else { return None };
    let table = |item: &'a Node| if let Value::Table(table) = &item.value { Some(table) } else { None };
    items.iter().map(table).collect()
}

/// Metres east and south of each place of a key; `None` where it has none, or something else.
fn places(step: &Table, key: &str) -> Option<Vec<[f64; 2]>> {
    let number = |table: &Table, key: &str| table.get(key)?.value.shown().parse::<f64>().ok();
    tables(step, key)?.into_iter().map(|table| Some([number(table, "x")?, number(table, "y")?])).collect()
}

/// The value of a key, in TOML notation, with one of its places elsewhere, to a tenth of a metre.
fn moved(step: &Table, key: &str, place: usize, at: [f64; 2]) -> Option<String> {
    let mut tables: Vec<Table> = tables(step, key)?.into_iter().cloned().collect();
    let table = tables.get_mut(place)?;
    for (name, metres) in ["x", "y"].into_iter().zip(at) {
        let value = Value::Number((10.0 * metres).round() / 10.0);
        table.set(name, Node { line: 0, value });
    }
    let list = tables.into_iter().map(|table| Node { line: 0, value: Value::Table(table) });
    Some(toml(&Value::List(list.collect())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::recipe::source::parse;

    #[test]
    fn one_place_is_moved_and_all_else_stays() {
        let text = "sources = [{ x = 1.0, y = 2, radius = 3.5, rate = 0.1 }, { x = 7, y = 8.0, radius = 1.0, rate = 2.0 }]";
        let step = parse("", text).expect("TOML");
        assert_eq!(places(&step, "sources"), Some(vec![[1.0, 2.0], [7.0, 8.0]]));
        assert_eq!(places(&step, "drains"), None);
        let text = moved(&step, "sources", 1, [40.04, 9.96]).expect("there");
        let again = parse("", &format!("sources = {text}")).expect("TOML");
        assert_eq!(places(&again, "sources"), Some(vec![[1.0, 2.0], [40.0, 10.0]]), "{text}");
        assert!(text.contains("radius = 3.5") && text.contains("rate = 2.0"), "{text}");
        assert_eq!(moved(&step, "sources", 2, [0.0; 2]), None);
    }
}
