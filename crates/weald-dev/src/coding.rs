//! Pictures as WebP: exact where that is cheap, as for line drawings, else lossy.

use std::path::Path;

use weald::Error;
use weald::picture::Image;
use webp::{Encoder, WebPConfig};

use crate::flip::{Flip, flip};

/// Qualities of lossy pictures, tried in this order.
const QUALITIES: [f32; 2] = [88.0, 94.0];

/// A lossy picture is at most so far from what it was made of: mean ꟻLIP over the square of 32 pixels in which it
/// differs most. Beside each other at full size the two look the same up to here.
const MAX_LOSS: f32 = 0.1;

/// An exact picture may be so many times as large as a lossy one.
const EXACT_COSTS: usize = 2;

/// A picture as the bytes of a file.
#[derive(Clone, Debug)]
pub struct Coded {
    /// The file.
    pub bytes: Vec<u8>,
    /// Quality from 0 to 100; none where every pixel is kept.
    pub quality: Option<f32>,
    /// How different what the file shows looks from the picture.
    pub loss: Flip,
}

/// The WebP of a picture.
///
/// # Errors
/// [`Error::Run`] where libwebp refuses it: sides beyond 16,383 pixels.
pub fn code(image: &Image) -> Result<Coded, Error> {
    let exact = encode(image, None)?;
    for quality in QUALITIES {
        let lossy = encode(image, Some(quality))?;
        if exact.len() <= EXACT_COSTS * lossy.len() {
            break;
        }
        let seen = from_webp(&lossy).expect("just encoded");
        let loss = flip(image, &seen);
        if loss.worst_square() <= MAX_LOSS {
            return Ok(Coded { bytes: lossy, quality: Some(quality), loss });
        }
    }
    Ok(Coded { bytes: exact, quality: None, loss: flip(image, image) })
}

/// Lossy of a quality, or exact without one.
fn encode(image: &Image, quality: Option<f32>) -> Result<Vec<u8>, Error> {
    let refused = |cause: &dyn std::fmt::Debug| {
        let Image { width, height, .. } = image;
        Error::Run(format!("libwebp cannot encode a picture of {width} × {height} pixels: {cause:?}"))
    };
    let mut config = WebPConfig::new().map_err(|()| refused(&"no configuration"))?;
    config.lossless = quality.is_none().into();
    // Without a quality it is the effort of packing: more than this costs minutes for 2 %.
    config.quality = quality.unwrap_or(75.0);
    config.method = if quality.is_some() { 6 } else { 4 };
    // Colours of edges, which halving the planes of colour would smear.
    config.use_sharp_yuv = 1;
    let encoder = Encoder::from_rgb(&image.rgb, image.width as u32, image.height as u32);
    Ok(encoder.encode_advanced(&config).map_err(|cause| refused(&cause))?.to_vec())
}

/// Reads a PNG as Weald draws it, or a WebP.
///
/// # Errors
/// [`Error::Run`] where it cannot be read or is neither.
pub fn decode(path: &Path) -> Result<Image, Error> {
    let bytes = std::fs::read(path).map_err(|cause| unreadable(path, &cause))?;
    let image = if bytes.starts_with(b"\x89PNG") { from_png(&bytes) } else { from_webp(&bytes) };
    image.map_err(|cause| unreadable(path, &cause))
}

fn unreadable(path: &Path, cause: &dyn std::fmt::Display) -> Error {
    Error::Run(format!("cannot read the picture {}: {cause}", path.display()))
}

fn from_png(bytes: &[u8]) -> Result<Image, String> {
    let read = |cause: png::DecodingError| cause.to_string();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().map_err(read)?;
    let size = reader.output_buffer_size().ok_or("it does not fit into memory")?;
    let mut rgb = vec![0; size];
    let info = reader.next_frame(&mut rgb).map_err(read)?;
    match (info.color_type, info.bit_depth) {
        (png::ColorType::Rgb, png::BitDepth::Eight) => {
            Ok(Image { width: info.width as usize, height: info.height as usize, rgb })
        }
        (colours, depth) => Err(format!("it has {colours:?} of {depth:?} bits, and may have Rgb of Eight")),
    }
}

fn from_webp(bytes: &[u8]) -> Result<Image, String> {
    let decoded = webp::Decoder::new(bytes).decode().ok_or("it is no whole WebP and no PNG")?;
    if decoded.is_alpha() {
        return Err("it has transparency, and may have none".to_owned());
    }
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    Ok(Image { width, height, rgb: decoded.to_vec() })
}

#[cfg(test)]
mod tests {
    use weald::random::hash2;

    use super::*;

    /// A thin dark line across paper.
    fn drawing() -> Image {
        let mut image = Image::paper(200, 150);
        for x in 0..200 {
            image.rgb[3 * (200 * (x / 2 + 20) + x)..][..3].fill(20);
        }
        image
    }

    /// Smooth colours with a little noise, as shaded ground has.
    fn ground() -> Image {
        let value = |at: usize| {
            let (x, y, channel) = (at / 3 % 300, at / 900, at % 3);
            (60 + x / 4 + y / 3 + 20 * channel) as u8 + (hash2(1, 0, at as i64) % 7) as u8
        };
        Image { width: 300, height: 200, rgb: (0..3 * 300 * 200).map(value).collect() }
    }

    #[test]
    fn a_drawing_keeps_every_pixel() {
        let coded = code(&drawing()).expect("coded");
        assert_eq!(coded.quality, None);
        assert_eq!(from_webp(&coded.bytes), Ok(drawing()));
    }

    #[test]
    fn ground_is_small_and_looks_alike() {
        let coded = code(&ground()).expect("coded");
        assert!(coded.quality.is_some());
        assert!(6 * coded.bytes.len() < ground().to_png(&[]).len(), "{} bytes", coded.bytes.len());
        assert_eq!(flip(&ground(), &from_webp(&coded.bytes).expect("whole")), coded.loss);
        assert!(coded.loss.worst_square() <= MAX_LOSS, "{:?}", coded.loss);
    }

    #[test]
    fn what_is_no_picture_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("page.webp");
        std::fs::write(&path, "# Gallery").expect("written");
        let error = decode(&path).expect_err("no picture").to_string();
        assert!(error.contains("page.webp") && error.contains("no PNG"), "{error}");
    }
}
