//! A finished picture with an alpha channel, where its background may show through.

use png::{BitDepth, ColorType};

use super::image::{Image, coloured_png};
use weald_io::png::Pixels;

/// A picture, with straight alpha where its background shows through.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cutout {
    /// The colours, not multiplied by alpha; black where alpha is 0.
    pub image: Image,
    /// Alpha of each pixel, from 0 (transparent) to 255 (opaque); `None` where all are opaque.
    pub alpha: Option<Vec<u8>>,
}

impl From<Image> for Cutout {
    fn from(image: Image) -> Self {
        Self { image, alpha: None }
    }
}

impl Cutout {
    /// Pixels on an opaque colour, row by row: encoded sRGB with premultiplied alpha.
    pub(super) fn on(width: usize, pixels: &[[f32; 4]], behind: [u8; 3]) -> Self {
        let behind = behind.map(|channel| f32::from(channel) / 255.0);
        let laid = |[red, green, blue, alpha]: &[f32; 4]| {
            let over = |light: f32, behind: f32| byte(light + (1.0 - alpha) * behind);
            [over(*red, behind[0]), over(*green, behind[1]), over(*blue, behind[2])]
        };
        Image { width, height: pixels.len() / width, rgb: pixels.iter().flat_map(laid).collect() }.into()
    }

    /// Pixels with premultiplied alpha, made straight, on a transparent background.
    pub(super) fn see_through(width: usize, pixels: &[[f32; 4]]) -> Self {
        let alone = |[red, green, blue, alpha]: &[f32; 4]| {
            [red, green, blue].map(|light| if *alpha > 0.0 { byte(light / alpha) } else { 0 })
        };
        let image =
            Image { width, height: pixels.len() / width, rgb: pixels.iter().flat_map(alone).collect() };
        Self { image, alpha: Some(pixels.iter().map(|pixel| byte(pixel[3])).collect()) }
    }

    /// Its pixels as a PNG file has them: three bytes each, or four with alpha.
    pub fn bytes(&self) -> Vec<u8> {
        let Some(alpha) = &self.alpha else { return self.image.rgb.clone() };
        let pixels = self.image.rgb.chunks_exact(3).zip(alpha);
        pixels.flat_map(|(rgb, &alpha)| [rgb[0], rgb[1], rgb[2], alpha]).collect()
    }

    /// How those bytes are to be understood.
    pub(super) fn colours(&self) -> ColorType {
        if self.alpha.is_some() { ColorType::Rgba } else { ColorType::Rgb }
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
