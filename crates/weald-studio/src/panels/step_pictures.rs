//! Small pictures of what steps do: one sheet, which `weald-dev steps` makes and which names its steps in their order.

use std::io::Cursor;
use std::sync::Arc;

use eframe::egui::{Id, Image, ImageSource, Rect, Sense, TextureHandle, TextureOptions, Ui, Vec2, pos2};

use super::pictures::decoded;

const SHEET: &[u8] = include_bytes!("pictures/steps.png");

/// Pictures beside each other.
const COLUMNS: usize = 8;

/// Size of a picture, in points.
const SIZE: Vec2 = Vec2::new(96.0, 54.0);

/// The sheet as a texture, and the names of its steps.
#[derive(Clone)]
struct Sheet {
    texture: TextureHandle,
    names: Arc<Vec<String>>,
}

/// Shows what a step does; `true` where the picture was clicked.
pub(super) fn show(ui: &mut Ui, step: &str) -> bool {
    let Some(Sheet { texture, names }) = sheet(ui) else { return false };
    let Some(place) = place_of(&names, step) else { return false };
    let source = ImageSource::Texture((texture.id(), SIZE).into());
    let text = format!("what {step} does");
    ui.add(Image::new(source).uv(place).alt_text(text).sense(Sense::click())).clicked()
}

fn sheet(ui: &Ui) -> Option<Sheet> {
    let id = Id::unique("pictures of steps");
    ui.data(|data| data.get_temp::<Sheet>(id)).or_else(|| {
        let texture = ui.ctx().load_texture("steps", decoded(SHEET)?, TextureOptions::LINEAR);
        let sheet = Sheet { texture, names: Arc::new(names()?) };
        ui.data_mut(|data| data.insert_temp(id, sheet.clone()));
        Some(sheet)
    })
}

/// Names of the steps, as the sheet has them.
fn names() -> Option<Vec<String>> {
    let reader = png::Decoder::new(Cursor::new(SHEET)).read_info().ok()?;
    let text = reader.info().uncompressed_latin1_text.iter().find(|text| text.keyword == "Steps")?;
    Some(text.text.split(' ').map(str::to_owned).collect())
}

/// Where the picture of a step lies, in shares of the sheet.
fn place_of(names: &[String], step: &str) -> Option<Rect> {
    let number = names.iter().position(|name| name == step)?;
    let rows = names.len().div_ceil(COLUMNS);
    let share = |column: usize, row: usize| pos2(column as f32 / COLUMNS as f32, row as f32 / rows as f32);
    let (column, row) = (number % COLUMNS, number / COLUMNS);
    Some(Rect::from_min_max(share(column, row), share(column + 1, row + 1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::recipe::catalog::CATALOG;

    #[test]
    fn every_step_has_a_picture_of_its_own() {
        let names = names().expect("the sheet names its steps");
        for entry in CATALOG {
            let place = place_of(&names, entry.name);
            assert!(place.is_some(), "`{}` has no picture: `weald-dev steps` draws it", entry.name);
        }
        assert_eq!(names.len(), CATALOG.len());
        let [width, height] = decoded(SHEET).expect("a PNG").size;
        assert_eq!([width, height], [COLUMNS * 96, names.len().div_ceil(COLUMNS) * 54]);
        let last = place_of(&names, &names[names.len() - 1]).expect("has a place");
        assert!(last.max.x <= 1.0 && last.max.y == 1.0, "{last:?}");
    }
}
