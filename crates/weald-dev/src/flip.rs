//! How different two pictures look when one is shown after the other in the same place: ꟻLIP, by its authors' own code
//! (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, doi 10.1145/3406183).

use nv_flip::{FlipImageRgb8, FlipPool};
use weald::picture::Image;

/// Pixels of a degree of what is seen, as its authors propose: a 4K screen 0.7 m wide from 0.7 m.
const PIXELS_PER_DEGREE: f32 = 67.02;

/// Side of the squares of [`Flip::squares`] in pixels: half a degree of what is seen, small
/// enough that a changed label of a few letters counts.
const SQUARE: usize = 32;

/// ꟻLIP of two pictures: 0 where they look the same, 1 at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Mean over all pixels.
    pub mean: f32,
    /// Of the pixel in which they differ most.
    pub most: f32,
    /// Mean over each square of 32 pixels, row by row. Those that a border cuts count as whole ones, lest a strip of a
    /// few pixels decide.
    pub squares: Vec<f32>,
}

impl Flip {
    /// Mean over the square in which the pictures differ most.
    pub fn worst_square(&self) -> f32 {
        self.squares.iter().copied().fold(0.0, f32::max)
    }
}

/// Compares two pictures of one size.
///
/// # Panics
/// Where their sizes differ.
pub fn flip(one: &Image, other: &Image) -> Flip {
    assert_eq!((one.width, one.height), (other.width, other.height), "pictures of one size");
    let [first, second] = [one, other]
        .map(|image| FlipImageRgb8::with_data(image.width as u32, image.height as u32, &image.rgb));
    let differences = nv_flip::flip(first, second, PIXELS_PER_DEGREE);
    let pixels = differences.to_vec();
    Flip {
        mean: FlipPool::from_image(&differences).mean(),
        most: pixels.iter().copied().fold(0.0, f32::max),
        squares: square_means(&pixels, one.width),
    }
}

fn square_means(pixels: &[f32], width: usize) -> Vec<f32> {
    let area = (SQUARE.min(width) * SQUARE.min(pixels.len() / width)) as f32;
    let mut means = Vec::new();
    for band in pixels.chunks(SQUARE * width) {
        let first = means.len();
        means.resize(first + width.div_ceil(SQUARE), 0.0);
        for row in band.chunks_exact(width) {
            for (mean, square) in means[first..].iter_mut().zip(row.chunks(SQUARE)) {
                *mean += square.iter().sum::<f32>() / area;
            }
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_spot_counts_in_its_square_though_the_whole_hardly_changes() {
        let paper = Image::paper(400, 300);
        let mut spotted = paper.clone();
        for y in 200..214 {
            for x in 330..344 {
                spotted.rgb[3 * (y * 400 + x)..][..3].fill(0);
            }
        }
        let none = flip(&paper, &paper);
        assert_eq!((none.mean, none.most, none.squares), (0.0, 0.0, vec![0.0; 13 * 10]));
        let spot = flip(&paper, &spotted);
        assert!(spot.mean < 0.003 && spot.worst_square() > 0.1 && spot.most > 0.5, "{spot:?}");
        assert_eq!(spot.worst_square(), spot.squares[6 * 13 + 10], "row 6, column 10");
    }
}
