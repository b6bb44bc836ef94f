//! The hand of the brush for plants: strokes of a step `paint-layer`, on whose layer a step that grows plants looks for how densely
//! they stand.

use toml_edit::{
    Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table as EditedTable, Value as EditedValue,
};
use weald::edit::Brush;
use weald::recipe::catalog;
use weald::recipe::source::{Node, Table, Value};

use super::Document;
use super::changes::{NOT_IN_TABLES, no_step, put, rearranged, step_of};

/// The step whose strokes are painted.
const PAINT: &str = "paint-layer";

/// A range of the painted layer by which as much of a plant's suitability is left as the layer says, smoothly.
const BY_DENSITY: [(&str, f64); 2] = [("above", 0.5), ("soft", 1.0)];

/// Places are written to this part of a metre: a brush is not finer, and the recipe stays short.
const PART_OF_METRE: f64 = 10.0;

impl Document {
    /// The steps that grow plants, by their places, with what they are called.
    pub fn growing(&self) -> Vec<(usize, String)> {
        let grows = |step: &Table| ["grass", "scatter"].contains(&Self::word(step)) && !Self::is_off(step);
        let steps = self.steps().into_iter().enumerate().filter(|(_, step)| grows(step));
        let named = |at: usize, step: &Table| match text_of(step, "plant") {
            Some(plant) => format!("{}. {} of {plant}", at + 1, Self::word(step)),
            None => format!("{}. {}", at + 1, Self::word(step)),
        };
        steps.map(|(at, step)| (at, named(at, step))).collect()
    }

    /// Paints how densely the plants of a step stand: towards `value`, from 0 to 1. The first stroke puts a step `paint-layer` before
    /// it. Gives the place of the step that grows, as one change.
    ///
    /// # Errors
    /// As [`Document::set_step_key`].
    pub fn paint_density(&mut self, at: usize, brush: &Brush, value: f64) -> Result<usize, String> {
        let (painted, step) = {
            let steps = self.steps();
            let step = (*steps.get(at).ok_or_else(|| no_step(at))?).clone();
            let layers = density_layers(&step);
            let is_painted = |table: &&Table| {
                Self::word(table) == PAINT
                    && !Self::is_off(table)
                    && text_of(table, "into").is_some_and(|into| layers.contains(&into))
            };
            (steps[..at].iter().rposition(is_painted), step)
        };
        let stroke = stroke_of(brush, value);
        let change = format!("plants of step {}: {}", at + 1, if value > 0.5 { "denser" } else { "sparser" });
        let Some(painted) = painted else {
            let name = self.free_name(&step);
            self.edit(change, |text| {
                insert(text, at, paint_step(&step, &name))?;
                look_at(text, at + 1, &step, &name)?;
                add_stroke(text, at, stroke)
            })?;
            return Ok(at + 1);
        };
        self.edit(change, |text| add_stroke(text, painted, stroke))?;
        Ok(at)
    }

    /// A name for the painted layer that nothing in the recipe has.
    fn free_name(&self, step: &Table) -> String {
        let plain =
            format!("{}_density", text_of(step, "into").unwrap_or_else(|| Self::word(step).to_owned()));
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let is_free = |name: &String| !self.text().contains(&format!("\"{name}\""));
        std::iter::once(plain.clone()).chain(numbered).find(is_free).unwrap_or(plain)
    }
}

fn text_of(table: &Table, key: &str) -> Option<String> {
    match table.get(key) {
        Some(Node { value: Value::Text(text), .. }) => Some(text.clone()),
        _ => None,
    }
}

/// Layers that say how densely the plants of a step stand.
fn density_layers(step: &Table) -> Vec<String> {
    if Document::word(step) == "grass" {
        return density_of_grass(step).into_iter().collect();
    }
    let Some(Node { value: Value::List(items), .. }) = step.get("where") else { return Vec::new() };
    let layers = items.iter().filter_map(|item| match &item.value {
        Value::Table(condition) => text_of(condition, "layer"),
        _ => None,
    });
    layers.collect()
}

/// What grass looks at, as it is written or by default.
fn density_of_grass(step: &Table) -> Option<String> {
    let usual = || {
        let parameters = (catalog::find("grass")?.parameters)();
        let density = parameters.into_iter().find(|parameter| parameter.name == "density")?;
        density.default.map(|name| name.trim_matches('"').to_owned())
    };
    text_of(step, "density").or_else(usual)
}

/// A step that paints on what the plants followed so far, or on ground that bears them everywhere alike.
fn paint_step(step: &Table, name: &str) -> EditedTable {
    let mut table = EditedTable::new();
    table.insert("do", toml_edit::value(PAINT));
    table.insert("into", toml_edit::value(name));
    if Document::word(step) == "grass"
        && let Some(before) = density_of_grass(step)
    {
        table.insert("of", toml_edit::value(before));
    }
    table
}

/// Lets a step that grows look at the painted layer.
fn look_at(text: &mut DocumentMut, at: usize, step: &Table, name: &str) -> Result<(), String> {
    let table = step_of(text, at)?;
    if Document::word(step) == "grass" {
        return put(table, "density", &format!("{name:?}"));
    }
    let conditions = table.entry("where").or_insert_with(|| toml_edit::value(Array::new()));
    match conditions {
        Item::Value(EditedValue::Array(items)) => {
            let mut condition = InlineTable::new();
            condition.insert("layer", name.into());
            for (key, value) in BY_DENSITY {
                condition.insert(key, value.into());
            }
            items.push(condition);
            Ok(())
        }
        Item::ArrayOfTables(tables) => {
            let mut condition = EditedTable::new();
            condition.insert("layer", toml_edit::value(name));
            for (key, value) in BY_DENSITY {
                condition.insert(key, toml_edit::value(value));
            }
            tables.push(condition);
            Ok(())
        }
        _ => Err("`where` is no list; change the text".to_owned()),
    }
}

/// Puts a step before the one at a place.
fn insert(text: &mut DocumentMut, at: usize, table: EditedTable) -> Result<(), String> {
    let steps: Option<&mut ArrayOfTables> = text.get_mut("step").and_then(Item::as_array_of_tables_mut);
    rearranged(steps.ok_or(NOT_IN_TABLES)?, |tables| {
        tables.insert(at.min(tables.len()), table);
        Ok(())
    })
}

fn stroke_of(brush: &Brush, value: f64) -> InlineTable {
    let rounded = |metres: f64| (metres * PART_OF_METRE).round() / PART_OF_METRE;
    let place = |place: &[f64; 2]| place.map(rounded).into_iter().collect::<Array>();
    let mut path = Array::new();
    brush.path.iter().map(place).for_each(|place| path.push(place));
    let mut stroke = InlineTable::new();
    stroke.insert("path", path.into());
    stroke.insert("radius", brush.radius.into());
    stroke.insert("falloff", brush.falloff.word().into());
    stroke.insert("strength", brush.strength.into());
    stroke.insert("value", value.into());
    stroke
}

/// Adds a stroke to a step, on a line of its own.
fn add_stroke(text: &mut DocumentMut, at: usize, stroke: InlineTable) -> Result<(), String> {
    let table = step_of(text, at)?;
    let strokes = table.entry("strokes").or_insert_with(|| toml_edit::value(Array::new()));
    let strokes = strokes.as_array_mut().ok_or("`strokes` is no list in one piece; change the text")?;
    let mut stroke = EditedValue::from(stroke);
    stroke.decor_mut().set_prefix("\n    ");
    strokes.push_formatted(stroke);
    strokes.set_trailing("\n");
    strokes.set_trailing_comma(true);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::edit::{Effect, Falloff};

    const TEXT: &str = "[landscape]\nsize = 32\ncell = 20.0\n\n[[step]]\ndo = \"diamond-square\"\n\n\
        [[step]]\ndo = \"scatter\" # ferns\nspacing = 8.0\n\n[[output]]\nlayer = \"plants\"\nfile = \"plants.tif\"\n";

    fn brush() -> Brush {
        let (falloff, effect) = (Falloff::Hard, Effect::Mask);
        Brush { path: vec![[320.04, 320.0], [400.0, 320.0]], radius: 60.0, falloff, strength: 1.0, effect }
    }

    #[test]
    fn the_first_stroke_puts_a_painted_layer_before_the_plants_and_the_next_goes_onto_it() {
        let mut document = Document::new("meadow.toml", TEXT);
        assert_eq!(document.growing(), [(1, "2. scatter".to_owned())]);
        assert_eq!(document.paint_density(1, &brush(), 0.0), Ok(2));
        assert!(document.diagnostics().is_empty(), "{:?}\n{}", document.diagnostics(), document.text());
        let text = document.text().to_owned();
        assert!(
            text.contains("do = \"scatter\" # ferns\nspacing = 8.0\nwhere = [{ layer = \"scatter_density\""),
            "{text}"
        );
        assert!(text.contains("path = [[320.0, 320.0], [400.0, 320.0]]"), "{text}");
        assert_eq!(document.paint_density(2, &brush(), 1.0), Ok(2));
        assert!(document.diagnostics().is_empty(), "{:?}", document.diagnostics());
        assert_eq!(document.text().matches("value = ").count(), 2);
        assert_eq!(document.text().matches("do = \"paint-layer\"").count(), 1);
        assert!(document.undo() && document.text() == text && document.undo() && document.text() == TEXT);
    }

    #[test]
    fn grass_keeps_what_its_density_was_where_nothing_is_painted() {
        let grass = "[[step]]\ndo = \"grass\"\nsoil = \"height\"\nlight = \"height\"\ndensity = \"height\"\n";
        let mut document = Document::new(
            "meadow.toml",
            TEXT.replace("[[step]]\ndo = \"scatter\"", &format!("{grass}\n[[step]]\ndo = \"scatter\"")),
        );
        assert!(document.diagnostics().is_empty(), "{:?}", document.diagnostics());
        document.paint_density(1, &brush(), 0.0).expect("painted");
        let text = document.text();
        assert!(document.diagnostics().is_empty(), "{:?}\n{text}", document.diagnostics());
        assert!(text.contains("do = \"paint-layer\"\ninto = \"grass_density\"\nof = \"height\"\n"), "{text}");
        assert!(text.contains("density = \"grass_density\""), "{text}");
    }
}
