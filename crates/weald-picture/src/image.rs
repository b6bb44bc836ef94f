//! A finished picture and its PNG.

use png::{BitDepth, ColorType, SrgbRenderingIntent};

use super::colour::{PAPER, encode};
use weald_io::png::Pixels;

/// Eight bits a channel, sRGB, row-major from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels from left to right, at least 1.
    pub width: usize,
    /// Pixels from top to bottom, at least 1.
    pub height: usize,
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

impl Image {
    /// An empty sheet of paper.
    pub fn paper(width: usize, height: usize) -> Self {
        Self { width, height, rgb: encode(PAPER).repeat(width * height) }
    }

    /// Red, green and blue of a pixel.
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        let at = 3 * (y * self.width + x);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// The bytes of a PNG file with a text chunk for each keyword (1 to 79 Latin letters) and its text.
    pub fn to_png(&self, text: &[(String, String)]) -> Vec<u8> {
        let (channels, depth) = (ColorType::Rgb, BitDepth::Eight);
        coloured_png(&Pixels { sides: [self.width, self.height], channels, depth, bytes: &self.rgb }, text)
    }

    /// Pictures from left to right, their tops level, `gap` pixels of paper between.
    pub fn beside(images: &[Self], gap: usize) -> Self {
        let gaps = gap * images.len().saturating_sub(1);
        let width = images.iter().map(|image| image.width).sum::<usize>() + gaps;
        let height = images.iter().map(|image| image.height).max().unwrap_or(0);
        let mut whole = Self::paper(width, height);
        let mut left = 0;
        for image in images {
            whole.paste(image, left, 0);
            left += image.width + gap;
        }
        whole
    }

    /// Pictures from top to bottom, `gap` pixels of paper between.
    pub fn below(images: &[Self], gap: usize) -> Self {
        let gaps = gap * images.len().saturating_sub(1);
        let width = images.iter().map(|image| image.width).max().unwrap_or(0);
        let height = images.iter().map(|image| image.height).sum::<usize>() + gaps;
        let mut whole = Self::paper(width, height);
        let mut top = 0;
        for image in images {
            whole.paste(image, 0, top);
            top += image.height + gap;
        }
        whole
    }

    fn paste(&mut self, image: &Self, left: usize, top: usize) {
        for (y, row) in image.rgb.chunks_exact(3 * image.width).enumerate() {
            let start = 3 * ((top + y) * self.width + left);
            self.rgb[start..start + row.len()].copy_from_slice(row);
        }
    }
}

/// The bytes of a PNG file of eight bits a channel in sRGB, with texts.
pub(super) fn coloured_png(pixels: &Pixels<'_>, text: &[(String, String)]) -> Vec<u8> {
    let file = pixels.marked(|encoder| {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        text.iter().try_for_each(|(keyword, text)| encoder.add_itxt_chunk(keyword.clone(), text.clone()))
    });
    file.expect("any text fits an iTXt chunk, and the buffer holds width × height pixels")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_decodes_to_the_same_pixels_and_keeps_its_text() {
        let image = Image { width: 2, height: 3, rgb: (0..18).collect() };
        let bytes = image.to_png(&[("weald".to_owned(), "größe 7 m".to_owned())]);
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
        let mut pixels = vec![0; 18];
        reader.next_frame(&mut pixels).expect("one frame");
        assert_eq!(pixels, image.rgb);
        let text = &reader.info().utf8_text[0];
        assert_eq!((text.keyword.as_str(), text.get_text().expect("text").as_str()), ("weald", "größe 7 m"));
    }

    #[test]
    fn pictures_beside_each_other_keep_their_pixels_and_are_parted_by_paper() {
        let dark = Image { width: 2, height: 2, rgb: vec![7; 12] };
        let light = Image { width: 1, height: 1, rgb: vec![200; 3] };
        let whole = Image::beside(&[dark, light], 1);
        assert_eq!((whole.width, whole.height), (4, 2));
        assert_eq!(whole.pixel(1, 1), [7; 3]);
        assert_eq!(whole.pixel(3, 0), [200; 3]);
        assert_eq!(whole.pixel(2, 0), encode(PAPER));
        assert_eq!(whole.pixel(3, 1), encode(PAPER));
    }
}
