//! A committed picture, written anew only where it looks different, so that history does not grow by noise.

use std::fmt;
use std::path::Path;

use weald::Error;
use weald::io::write_whole;
use weald::picture::Image;

use crate::coding::{code, decode};
use crate::film::{self, Frames};
use crate::flip::{Flip, flip};

/// A picture looks different where the committed one is so much further from it than its own coding, in mean ꟻLIP over
/// some square of 32 pixels. Values rounded otherwise stay below 0.01; a changed letter, a patch 4 % brighter or one pixel
/// aside are 0.05 and more.
pub const VISIBLE: f32 = 0.03;

/// What became of a committed picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kept {
    /// It looks as it did: how much further it is than its coding, in ꟻLIP of a square.
    AsItWas(f32),
    /// It was written: bytes, quality (none where every pixel is kept), and the ꟻLIP of the worst square that coding costs.
    Written(usize, Option<f32>, f32),
}

impl fmt::Display for Kept {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AsItWas(worst) => write!(formatter, "looks as it did (FLIP {worst:.3})"),
            Self::Written(bytes, None, _) => write!(formatter, "written: {bytes} bytes, exact"),
            Self::Written(bytes, Some(quality), loss) => {
                write!(formatter, "written: {bytes} bytes, quality {quality}, FLIP of coding {loss:.3}")
            }
        }
    }
}

/// Commits the picture `from` as the WebP `to`, where that is missing, looks different, or is to be written `anew`.
///
/// # Errors
/// [`Error::Run`] where a file cannot be read or written, or `to` does not end in `.webp`.
pub fn keep(from: &Path, to: &Path, anew: bool) -> Result<Kept, Error> {
    if to.extension().is_none_or(|end| end != "webp") {
        return Err(Error::Run(format!("{} must end in .webp", to.display())));
    }
    if let Some(film) = Frames::of_file(from)? {
        return keep_film(&film, to, anew);
    }
    let image = decode(from)?;
    let coded = code(&image)?;
    if to.exists() && !anew {
        let further = beyond(&image, &decode(to)?, &coded.loss);
        if further <= VISIBLE {
            return Ok(Kept::AsItWas(further));
        }
    }
    write_whole(to, &coded.bytes)?;
    Ok(Kept::Written(coded.bytes.len(), coded.quality, coded.loss.worst_square()))
}

fn keep_film(film: &Frames, to: &Path, anew: bool) -> Result<Kept, Error> {
    if to.exists() && !anew {
        let unreadable = |cause| Error::Run(format!("cannot read the film {}: {cause}", to.display()));
        let (looks_alike, worst) = film.looks_like(&std::fs::read(to).map_err(unreadable)?);
        if looks_alike {
            return Ok(Kept::AsItWas(worst));
        }
    }
    let coded = film.code()?;
    write_whole(to, &coded)?;
    Ok(Kept::Written(coded.len(), Some(film::QUALITY), film.looks_like(&coded).1))
}

/// How much further a committed picture is from a new one than the new one's coding, in the square where that is most;
/// 1 where they differ in size. Two codings beside each other would not do: they differ by chance.
fn beyond(image: &Image, committed: &Image, loss: &Flip) -> f32 {
    if (image.width, image.height) != (committed.width, committed.height) {
        return 1.0;
    }
    let apart = flip(image, committed).squares;
    apart.iter().zip(&loss.squares).map(|(apart, loss)| apart - loss).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of one grey beside paper.
    fn grey(light: u8) -> Image {
        let sheet = Image { width: 96, height: 96, rgb: vec![light; 3 * 96 * 96] };
        Image::beside(&[sheet, Image::paper(400, 96)], 4)
    }

    #[test]
    fn only_what_looks_different_or_is_asked_for_is_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let (from, to) = (folder.path().join("grey.png"), folder.path().join("grey.webp"));
        let kept = |image: &Image, anew: bool| {
            std::fs::write(&from, image.to_png(&[])).expect("written");
            keep(&from, &to, anew).expect("kept")
        };
        let mut rounded = grey(100);
        rounded.rgb[..96 * 96].iter_mut().step_by(50).for_each(|value| *value += 1);
        assert!(matches!(kept(&grey(100), false), Kept::Written(..)), "there was none");
        let first = std::fs::read(&to).expect("a picture");
        assert_eq!(kept(&grey(100), false), Kept::AsItWas(0.0));
        assert!(
            matches!(kept(&rounded, false), Kept::AsItWas(further) if further > 0.0),
            "rounding is not seen"
        );
        assert_eq!(std::fs::read(&to).expect("a picture"), first, "and not written");
        assert!(matches!(kept(&rounded, true), Kept::Written(..)), "asked for");
        assert!(matches!(kept(&grey(110), false), Kept::Written(..)), "seen");
        assert_eq!(decode(&to).expect("a picture"), grey(110));
    }

    #[test]
    fn another_size_is_another_picture() {
        let folder = tempfile::tempdir().expect("a folder");
        let (from, to) = (folder.path().join("sheet.png"), folder.path().join("sheet.webp"));
        for side in [40, 41] {
            std::fs::write(&from, Image::paper(side, side).to_png(&[])).expect("written");
            assert!(matches!(keep(&from, &to, false), Ok(Kept::Written(..))), "{side}");
        }
        let error = keep(&from, &folder.path().join("sheet.jpg"), false).expect_err("no WebP").to_string();
        assert!(error.contains("sheet.jpg") && error.contains(".webp"), "{error}");
    }
}
