//! Films as animated WebP, made of animated PNG and written anew only where they look different.

use std::io::Cursor;
use std::path::Path;

use weald::Error;
use weald::picture::Image;
use webp::{AnimDecoder, AnimEncoder, AnimFrame, WebPConfig};

use crate::flip::flip;

/// Quality of the frames: a film is looked at as it moves, and may be softer than a picture.
pub(crate) const QUALITY: f32 = 72.0;

/// Mean ꟻLIP of the square that differs most, up to which a frame looks as it did, coding included.
const ALIKE: f32 = 0.2;

/// Frames, and how long each is shown, in milliseconds.
#[derive(Clone, Debug)]
pub(crate) struct Frames {
    /// All of one size.
    pub(crate) images: Vec<Image>,
    /// Milliseconds from frame to frame.
    pub(crate) delay: u32,
}

impl Frames {
    /// The frames of a file that is an animated PNG; `None` for any other.
    ///
    /// # Errors
    /// [`Error::Run`] for a file that cannot be read.
    pub(crate) fn of_file(path: &Path) -> Result<Option<Self>, Error> {
        let unreadable = |cause: &dyn std::fmt::Display| {
            Error::Run(format!("cannot read the picture {}: {cause}", path.display()))
        };
        let bytes = std::fs::read(path).map_err(|cause| unreadable(&cause))?;
        if !bytes.starts_with(b"\x89PNG") {
            return Ok(None);
        }
        Self::of_png(&bytes).map_err(|cause| unreadable(&cause))
    }

    /// The frames of an animated PNG; `None` for a picture that does not move.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub(crate) fn of_png(bytes: &[u8]) -> Result<Option<Self>, String> {
        let read = |cause: png::DecodingError| cause.to_string();
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(read)?;
        let Some(animation) = reader.info().animation_control() else { return Ok(None) };
        let count = animation.num_frames;
        let control = reader.info().frame_control();
        let delay = control
            .map_or(100, |control| 1000 * u32::from(control.delay_num) / u32::from(control.delay_den.max(1)));
        let size = reader.output_buffer_size().ok_or("it does not fit into memory")?;
        let mut images = Vec::new();
        for _ in 0..count {
            let mut rgb = vec![0; size];
            let info = reader.next_frame(&mut rgb).map_err(read)?;
            if info.color_type != png::ColorType::Rgb || info.bit_depth != png::BitDepth::Eight {
                return Err(format!("a frame has {:?}, and may have Rgb", info.color_type));
            }
            images.push(Image { width: info.width as usize, height: info.height as usize, rgb });
        }
        Ok(Some(Self { images, delay }))
    }

    /// The bytes of an animated WebP.
    ///
    /// # Errors
    /// [`Error::Run`] where libwebp refuses it.
    pub(crate) fn code(&self) -> Result<Vec<u8>, Error> {
        let refused = |cause: &str| Error::Run(format!("libwebp cannot encode the film: {cause}"));
        let first = self.images.first().ok_or_else(|| refused("it has no frames"))?;
        let mut config = WebPConfig::new().map_err(|()| refused("no configuration"))?;
        (config.lossless, config.quality, config.method) = (0, QUALITY, 4);
        let (width, height) = (first.width as u32, first.height as u32);
        let mut encoder = AnimEncoder::new(width, height, &config);
        for (place, image) in self.images.iter().enumerate() {
            encoder.add_frame(AnimFrame::from_rgb(
                &image.rgb,
                width,
                height,
                place as i32 * self.delay as i32,
            ));
        }
        let coded = encoder.try_encode().map_err(|cause| refused(&format!("{cause:?}")))?;
        Ok(coded.to_vec())
    }

    /// Whether a coded film shows the same to the eye, and how far its worst frame is.
    pub(crate) fn looks_like(&self, coded: &[u8]) -> (bool, f32) {
        let Ok(decoded) = AnimDecoder::new(coded).decode() else { return (false, 1.0) };
        if decoded.len() != self.images.len() {
            return (false, 1.0);
        }
        let worst = self.images.iter().enumerate().map(|(place, image)| {
            let frame = decoded.get_frame(place).filter(|frame| {
                (frame.width() as usize, frame.height() as usize) == (image.width, image.height)
            });
            frame.map_or(1.0, |frame| {
                let rgb = frame.get_image().chunks(frame.get_image().len() / (image.width * image.height));
                let rgb = rgb.flat_map(|pixel| pixel[..3].to_vec()).collect();
                flip(image, &Image { rgb, ..*image }).worst_square()
            })
        });
        let worst = worst.fold(0.0, f32::max);
        (worst <= ALIKE, worst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::{Cutout, write_apng};

    /// A bright square that moves over grey.
    fn frame(place: usize) -> Image {
        let mut image = Image { width: 96, height: 64, rgb: vec![90; 3 * 96 * 64] };
        for y in 20..40 {
            let at = 3 * (96 * y + 8 * place);
            image.rgb[at..at + 60].fill(230);
        }
        image
    }

    #[test]
    fn a_film_is_read_from_png_coded_and_known_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film.png");
        let draw = |place: u64| Ok(Cutout::from(frame(place as usize)));
        write_apng(&path, (6, 8.0), draw).expect("written");
        let film = Frames::of_file(&path).expect("read").expect("a film");
        assert_eq!((film.images.len(), film.delay), (6, 125));
        assert_eq!(film.images[5], frame(5));
        let coded = film.code().expect("coded");
        assert!(film.looks_like(&coded).0, "{}", film.looks_like(&coded).1);
        let mut other = film.clone();
        other.images[3] = frame(9);
        assert!(!other.looks_like(&coded).0, "a frame differs");
        other.images.pop();
        assert!(!other.looks_like(&coded).0, "a frame is missing");
        std::fs::write(&path, frame(0).to_png(&[])).expect("written");
        assert!(Frames::of_file(&path).expect("read").is_none(), "it does not move");
    }
}
