//! Pictures of the templates.
//!
//! They are the views that templates draw, of a real model over a ridge of its own, or else what a render shows of them,
//! 160 × 90 pixels with a palette:
//!
//! ```text
//! weald render highland.toml --size 640x360 --output highland.png
//! ffmpeg -i highland.png small.png -vf \
//!     "scale=160:90:flags=lanczos,split[a][b];[a]palettegen=reserve_transparent=0[p];[b][p]paletteuse"
//! ```

use std::io::Cursor;

use eframe::egui::{ColorImage, Id, ImageSource, Sense, TextureHandle, TextureOptions, Ui, Vec2};

/// Names of templates with their pictures.
const PICTURES: [(&str, &[u8]); 11] = [
    ("highland", include_bytes!("pictures/highland.png")),
    ("fault", include_bytes!("pictures/fault.png")),
    ("layers", include_bytes!("pictures/layers.png")),
    ("dem", include_bytes!("pictures/dem.png")),
    ("range", include_bytes!("pictures/range.png")),
    ("island", include_bytes!("pictures/island.png")),
    ("fjord", include_bytes!("pictures/fjord.png")),
    ("delta", include_bytes!("pictures/delta.png")),
    ("volcano", include_bytes!("pictures/volcano.png")),
    ("canyon", include_bytes!("pictures/canyon.png")),
    ("meadow", include_bytes!("pictures/meadow.png")),
];

/// Size of a picture, in points.
const SIZE: Vec2 = Vec2::new(128.0, 72.0);

/// Shows the picture of a template, where it has one; `true` where it was clicked.
pub(super) fn show(ui: &mut Ui, template: &str) -> bool {
    let Some((name, bytes)) = PICTURES.iter().find(|(name, _)| *name == template) else { return false };
    let id = Id::unique(("picture", *name));
    let kept = ui.data(|data| data.get_temp::<TextureHandle>(id));
    let texture = kept.or_else(|| {
        let texture = ui.ctx().load_texture(*name, decoded(bytes)?, TextureOptions::LINEAR);
        ui.data_mut(|data| data.insert_temp(id, texture.clone()));
        Some(texture)
    });
    let Some(texture) = texture else { return false };
    let source = ImageSource::Texture((texture.id(), SIZE).into());
    let image = eframe::egui::Image::new(source).alt_text(format!("picture of {name}")).sense(Sense::click());
    ui.add(image).clicked()
}

pub(super) fn decoded(bytes: &[u8]) -> Option<ColorImage> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let mut rgb = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut rgb).ok()?;
    (info.color_type == png::ColorType::Rgb)
        .then(|| ColorImage::from_rgb([info.width as usize, info.height as usize], &rgb))
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::recipe::template::TEMPLATES;

    #[test]
    fn every_template_has_a_picture_that_can_be_read() {
        for template in TEMPLATES {
            let picture = PICTURES.iter().find(|(name, _)| *name == template.name).expect("a picture");
            assert_eq!(decoded(picture.1).expect("a PNG").size, [160, 90], "{}", template.name);
        }
    }
}
