//! From densities to light.
//!
//! The cover of a bucket grows with the logarithm of its points, `a ∝ log(1 + k n)`, then buckets become pixels under
//! a Gaussian, then the cover is raised to `1 / gamma`, linearly below a threshold, and laid on the background.
//! `vibrancy` says whether gamma acts on the cover alone, which keeps colours saturated, or on each channel. Source:
//! Draves and Reckase 2003, "The fractal flame algorithm", sections 3, 6 and 7, and flam3 3.1 (`rect.c`).
//!
//! What differs: colours are mixed in linear light, while covers act on encoded sRGB, as those of transparent pictures
//! do in browsers. `k` is not a density of the plane but refers to the bucket in which a point of the shape usually
//! lies, by [`Density::usual_share`]: so brightness depends neither on the number of points nor on the size of the
//! picture, and thin and thick shapes come out equally well.

use rayon::prelude::*;

use super::super::colour::encode;
use super::density::{Bucket, Density};

/// How many times as dense as usual a bucket is that is covered whole.
const WHOLE: f64 = 1.6;

/// Bend of the logarithm: how many times its start is steeper than a straight line to its end, nearly.
const BEND: f64 = 30.0;

/// Where the Gaussian of a width of one pixel is cut off, in pixels.
const SUPPORT: f64 = 1.5;

/// How densities become light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Brightness in stops: each 1 more is as if there were twice as many points.
    pub exposure: f64,
    /// Exponent of the cover.
    pub gamma: f64,
    /// Cover up to which gamma is a straight line, so that single points do not shine.
    pub threshold: f64,
    /// 1 keeps colours saturated, 0 lets each channel have its own gamma.
    pub vibrancy: f64,
    /// Width of the filter in pixels.
    pub filter: f64,
}

/// A pixel before its background: channels multiplied by the cover, and the cover.
pub(super) type Covered = [f32; 4];

impl Tone {
    /// The pixels of a histogram with so many buckets a pixel and side. `usual_share` is the share of the points
    /// that lies in the bucket of a usual one.
    pub(super) fn develop(&self, density: &Density, fine: usize, usual_share: f64) -> Vec<Covered> {
        let width = density.width / fine;
        let cover = Cover::new(self, density.points as f64 * usual_share);
        let weights = self.weights(fine);
        let mut pixels = vec![[0.0; 4]; width * (density.height / fine)];
        pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            let column = column_sums(density, y * fine, &weights, &cover);
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = self.raised(weighted(&column, x * fine, &weights));
            }
        });
        pixels
    }

    /// Weights of the buckets around the middle of a pixel, at distances of whole buckets from its first.
    fn weights(&self, fine: usize) -> Vec<(isize, f32)> {
        let reach = (SUPPORT * self.filter).max(0.5);
        let weight = |distance: f64| {
            let share = distance / self.filter.max(1e-9);
            if distance.abs() < 0.5 && self.filter < 1e-3 { 1.0 } else { libm::exp(-2.0 * share * share) }
        };
        let outmost = (reach * fine as f64).ceil() as isize + fine as isize;
        let place = |bucket: isize| (bucket as f64 + 0.5) / fine as f64 - 0.5;
        let near = (-outmost..=outmost).filter(|&bucket| place(bucket).abs() < reach + 1e-9);
        let weights: Vec<(isize, f64)> = near.map(|bucket| (bucket, weight(place(bucket)))).collect();
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        weights.into_iter().map(|(bucket, weight)| (bucket, (weight / sum) as f32)).collect()
    }

    /// Gamma and vibrancy of a pixel.
    fn raised(&self, light: Covered) -> Covered {
        let cover = f64::from(light[3]);
        if cover <= 0.0 {
            return [0.0; 4];
        }
        let lifted = self.lifted(cover).min(1.0);
        let channel = |mean: f32| {
            let mean = f64::from(mean);
            let alone = if self.vibrancy < 1.0 { self.lifted(mean * cover) } else { 0.0 };
            (self.vibrancy * mean * lifted + (1.0 - self.vibrancy) * alone).min(1.0) as f32
        };
        let [red, green, blue] = encoded(light).map(channel);
        [red, green, blue, lifted as f32]
    }

    /// `x^(1/gamma)`; below the threshold ever more of the straight line that meets it there.
    fn lifted(&self, x: f64) -> f64 {
        let power = libm::pow(x, 1.0 / self.gamma);
        if x >= self.threshold {
            return power;
        }
        let line = x / self.threshold * libm::pow(self.threshold, 1.0 / self.gamma);
        let share = x / self.threshold;
        (1.0 - share) * line + share * power
    }
}

/// Covers of buckets.
struct Cover {
    /// Of the counts that most buckets have.
    table: Vec<f32>,
    slope: f64,
    height: f64,
}

/// Counts whose cover is looked up.
const TABLE: u32 = 4096;

impl Cover {
    /// `usual` is the number of points in the bucket of a usual point.
    fn new(tone: &Tone, usual: f64) -> Self {
        let slope = BEND * libm::exp2(tone.exposure) / usual.max(f64::MIN_POSITIVE) / WHOLE;
        let mut cover = Self { table: Vec::new(), slope, height: 1.0 / libm::log1p(BEND) };
        cover.table = (0..TABLE).map(|count| cover.compute(count)).collect();
        cover
    }

    fn compute(&self, count: u32) -> f32 {
        (self.height * libm::log1p(self.slope * f64::from(count))).min(1.0) as f32
    }

    /// The light of a bucket.
    #[inline]
    fn of(&self, bucket: &Bucket) -> Covered {
        if bucket.count == 0 {
            return [0.0; 4];
        }
        let cover =
            if bucket.count < TABLE { self.table[bucket.count as usize] } else { self.compute(bucket.count) };
        let [red, green, blue] = bucket.mean();
        [red * cover, green * cover, blue * cover, cover]
    }
}

/// Sums down the rows around a row of pixels, a sum for each column of buckets.
fn column_sums(density: &Density, first: usize, weights: &[(isize, f32)], cover: &Cover) -> Vec<Covered> {
    let mut sums = vec![[0.0; 4]; density.width];
    for &(distance, weight) in weights {
        let Some(row) = first.checked_add_signed(distance).filter(|&row| row < density.height) else {
            continue;
        };
        let buckets = &density.buckets[row * density.width..(row + 1) * density.width];
        for (sum, bucket) in sums.iter_mut().zip(buckets) {
            add(sum, cover.of(bucket), weight);
        }
    }
    sums
}

/// The sum along a row around a pixel.
fn weighted(column: &[Covered], first: usize, weights: &[(isize, f32)]) -> Covered {
    let mut sum = [0.0; 4];
    for &(distance, weight) in weights {
        let light = first.checked_add_signed(distance).and_then(|at| column.get(at));
        if let Some(&light) = light {
            add(&mut sum, light, weight);
        }
    }
    sum
}

#[inline]
fn add(sum: &mut Covered, light: Covered, weight: f32) {
    for (sum, light) in sum.iter_mut().zip(light) {
        *sum += weight * light;
    }
}

/// The colour of a pixel without its cover, in encoded sRGB, 0 to 1.
pub(super) fn encoded([red, green, blue, cover]: Covered) -> [f32; 3] {
    encode([red, green, blue].map(|light| light / cover)).map(|channel| f32::from(channel) / 255.0)
}
