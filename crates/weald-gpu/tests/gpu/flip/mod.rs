//! How different two pictures look when one is shown after the other in the same place: ꟻLIP, by its authors' own code
//! (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, doi 10.1145/3406183).

#![allow(dead_code, reason = "each test file uses a part")]

use nv_flip::{FlipImageRgb8, FlipPool};
use weald::picture::Image;

/// Pixels of a degree of what is seen, as its authors propose: a 4K screen 0.7 m wide from 0.7 m.
const PIXELS_PER_DEGREE: f32 = 67.02;

/// ꟻLIP of two pictures: 0 where they look the same, 1 at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flip {
    /// Over all pixels.
    pub(crate) mean: f32,
    /// Of the pixel in which they differ most.
    pub(crate) most: f32,
}

/// Compares two pictures of one size.
pub(crate) fn flip(one: &Image, other: &Image) -> Flip {
    let [one, other] = [one, other]
        .map(|image| FlipImageRgb8::with_data(image.width as u32, image.height as u32, &image.rgb));
    let differences = nv_flip::flip(one, other, PIXELS_PER_DEGREE);
    let most = differences.to_vec().into_iter().fold(0.0, f32::max);
    Flip { mean: FlipPool::from_image(&differences).mean(), most }
}

/// The means of squares of so many pixels, so that the samples of a pixel are many.
pub(crate) fn reduced(image: &Image, by: usize) -> Image {
    let (width, height) = (image.width / by, image.height / by);
    let mean = |x: usize, y: usize| {
        let pixels = (0..by * by).map(|at| image.pixel(x * by + at % by, y * by + at / by));
        let sum = pixels.fold([0; 3], |sum, pixel| [0, 1, 2].map(|i| sum[i] + usize::from(pixel[i])));
        sum.map(|sum| ((sum + by * by / 2) / (by * by)) as u8)
    };
    let rgb = (0..width * height).flat_map(|at| mean(at % width, at / width)).collect();
    Image { width, height, rgb }
}
