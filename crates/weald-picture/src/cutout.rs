//! A finished picture whose background may show through.

use png::{BitDepth, ColorType};

use super::image::{Image, coloured_png};
use weald_io::png::Pixels;

/// A picture, with the cover of each pixel where its background shows through.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cutout {
    /// The colours; black where nothing covers.
    pub image: Image,
    /// Cover of each pixel, 0 to 255; `None` where all are covered.
    pub cover: Option<Vec<u8>>,
}

impl From<Image> for Cutout {
    fn from(image: Image) -> Self {
        Self { image, cover: None }
    }
}

impl Cutout {
    /// Pixels on a colour, row by row: encoded sRGB multiplied by the cover, and the cover.
    pub(super) fn on(width: usize, pixels: &[[f32; 4]], behind: [u8; 3]) -> Self {
        let behind = behind.map(|channel| f32::from(channel) / 255.0);
        let laid = |[red, green, blue, cover]: &[f32; 4]| {
            let over = |light: f32, behind: f32| byte(light + (1.0 - cover) * behind);
            [over(*red, behind[0]), over(*green, behind[1]), over(*blue, behind[2])]
        };
        Image { width, height: pixels.len() / width, rgb: pixels.iter().flat_map(laid).collect() }.into()
    }

    /// Pixels on nothing.
    pub(super) fn see_through(width: usize, pixels: &[[f32; 4]]) -> Self {
        let alone = |[red, green, blue, cover]: &[f32; 4]| {
            [red, green, blue].map(|light| if *cover > 0.0 { byte(light / cover) } else { 0 })
        };
        let image =
            Image { width, height: pixels.len() / width, rgb: pixels.iter().flat_map(alone).collect() };
        Self { image, cover: Some(pixels.iter().map(|pixel| byte(pixel[3])).collect()) }
    }

    /// Its pixels as a PNG file has them: three bytes each, or four with the cover.
    pub fn bytes(&self) -> Vec<u8> {
        let Some(cover) = &self.cover else { return self.image.rgb.clone() };
        let pixels = self.image.rgb.chunks_exact(3).zip(cover);
        pixels.flat_map(|(rgb, &cover)| [rgb[0], rgb[1], rgb[2], cover]).collect()
    }

    /// How those bytes are to be understood.
    pub(super) fn colours(&self) -> ColorType {
        if self.cover.is_some() { ColorType::Rgba } else { ColorType::Rgb }
    }

    /// The bytes of a PNG file, with texts as those of [`Image::to_png`].
    pub fn to_png(&self, text: &[(String, String)]) -> Vec<u8> {
        let sides = [self.image.width, self.image.height];
        let (channels, depth) = (self.colours(), BitDepth::Eight);
        coloured_png(&Pixels { sides, channels, depth, bytes: &self.bytes() }, text)
    }
}

fn byte(share: f32) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}
