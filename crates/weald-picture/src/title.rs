//! A line of writing above a picture.

use super::colour::Linear;
use super::font::Pen;
use super::image::Image;

/// Colour of writing.
const INK: Linear = [0.06, 0.05, 0.04];

impl Image {
    /// The picture below a line of writing.
    #[must_use]
    pub fn titled(&self, title: &str) -> Self {
        let pen = Pen { unit: 1.25, ink: INK };
        let mut line = Self::paper(self.width, (2.6 * pen.height()) as usize);
        pen.write(&mut line, title, [2.0, 0.7 * pen.height()]);
        Self::below(&[line, self.clone()], 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_stands_above_its_picture_and_leaves_it_as_it_was() {
        let image = Image { width: 40, height: 2, rgb: (0..240).collect() };
        let titled = image.titled("k 0.5");
        let above = titled.height - image.height;
        assert_eq!(titled.rgb[3 * 40 * above..], image.rgb);
        let dark = titled.rgb[..3 * 40 * above].chunks(3).filter(|pixel| pixel[0] < 100).count();
        assert!(dark > 15, "{dark} dark pixels");
    }
}
