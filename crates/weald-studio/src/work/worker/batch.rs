//! Seeds that wait, and the pictures of those that are done on one sheet.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use weald::Error;
use weald::picture::{Image, Pen};

/// Pixels along a picture's longer side, and between two pictures of the sheet.
pub(super) const SIDE: u32 = 192;
const GAP: usize = 8;

/// Name of the sheet.
const SHEET: &str = "contact-sheet.png";

/// Seeds that wait.
pub(super) struct Batch {
    pub(super) folder: PathBuf,
    pub(super) waiting: VecDeque<u64>,
    pub(super) images: Vec<Image>,
}

/// A picture with its seed written below.
pub(super) fn labelled(image: Image, seed: u64) -> Image {
    let pen = Pen { unit: 1.5, ink: [0.0; 3] };
    let mut label = Image::paper(image.width, 3 * pen.height() as usize);
    pen.write(&mut label, &seed.to_string(), [2.0, pen.height()]);
    Image::below(&[image, label], 0)
}

/// The sheet is about as wide as it is high.
pub(super) fn write_sheet(images: &[Image], folder: &Path) -> Result<PathBuf, Error> {
    let columns = (images.len() as f64).sqrt().ceil() as usize;
    let rows: Vec<_> = images.chunks(columns.max(1)).map(|row| Image::beside(row, GAP)).collect();
    let file = folder.join(SHEET);
    weald::io::write_whole(&file, &Image::below(&rows, GAP).to_png(&[]))?;
    Ok(file)
}
