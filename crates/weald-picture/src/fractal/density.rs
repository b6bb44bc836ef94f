//! How many points fall on each part of a picture, and the sum of their colours.
//!
//! The game is played in batches of chunks. Each thread sorts the points of a chunk by bands of rows; then each band
//! takes the points of all chunks in their order. So one histogram does for all threads, a band stays in the cache
//! while it is filled, and no number depends on how many threads there are: sums are of whole numbers.

use rayon::prelude::*;

use super::super::Watch;
use super::colouring::Colouring;
use super::frame::Frame;
use super::palette::{self, PaletteIndex};
use super::subject::Subject;
use weald_core::error::{Error, Limit, Quantity};
use weald_plants::ifs::Game;
use weald_plants::ifs::game::CHUNK;

/// Most memory of a histogram: 4 GiB.
const MAX_BYTES: u64 = 4 << 30;

/// Most points of a picture.
const MAX_POINTS: f64 = 1e12;

/// Chunks that are played before their points are counted: 33 MB.
const BATCH: u64 = 16;

/// Bands of a histogram.
const BANDS: usize = 64;

/// Points of a bucket whose colours count: as many as sums of 32 bits hold.
const COLOURED: u32 = 1 << 16;

/// A part of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bucket {
    /// Points in it.
    pub count: u32,
    /// Sum of the colours of the first 65536 of them, each channel 0 to 65535 in linear light.
    pub colour: [u32; 3],
}

impl Bucket {
    fn add(&mut self, colour: [u16; 3]) {
        if self.count < COLOURED {
            for (sum, channel) in self.colour.iter_mut().zip(colour) {
                *sum += u32::from(channel);
            }
        }
        self.count = self.count.saturating_add(1);
    }

    /// The mean colour of its points.
    #[inline]
    pub(super) fn mean(&self) -> [f32; 3] {
        let scale = 1.0 / (65535.0 * self.count.clamp(1, COLOURED) as f32);
        self.colour.map(|sum| sum as f32 * scale)
    }
}

/// How densely a picture is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Points for each pixel of the picture.
    pub samples: f64,
    /// Buckets along the side of a pixel.
    pub supersample: usize,
}

/// The points of a picture, counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    /// Buckets from left to right.
    pub width: usize,
    /// Buckets from top to bottom.
    pub height: usize,
    /// Row by row from the top.
    pub buckets: Vec<Bucket>,
    /// Points that were played, those outside the frame with them.
    pub points: u64,
}

/// A point on its way to its bucket.
#[derive(Clone, Copy)]
struct Entry {
    bucket: u32,
    palette_index: PaletteIndex,
}

/// What is played into which buckets.
struct Drawing<'a> {
    subject: &'a Subject<'a>,
    colouring: Colouring,
    frame: &'a Frame,
    sampling: Sampling,
    width: usize,
    height: usize,
    band: usize,
}

impl Density {
    /// Plays the game into a histogram. `watch` is called with how many points are done, of how many, and may end it.
    ///
    /// # Errors
    /// [`Error::Limit`] where the histogram would take more than 4 GiB or the points are more than 10^12, and those
    /// of `watch`.
    pub(super) fn count(
        subject: &Subject<'_>,
        (colouring, palette): (Colouring, &[[u16; 3]]),
        frame: &Frame,
        sampling: Sampling,
        watch: &mut Watch<'_>,
    ) -> Result<Self, Error> {
        let points = checked(frame, sampling)?;
        let [width, height] = [frame.width, frame.height].map(|side| side * sampling.supersample);
        let band = height.div_ceil(BANDS) * width;
        let drawing = Drawing { subject, colouring, frame, sampling, width, height, band };
        let mut buckets = vec![Bucket::default(); width * height];
        let game = Game::new(subject.ifs, subject.seed);
        let chunks = points.div_ceil(CHUNK);
        for first in (0..chunks).step_by(BATCH as usize) {
            watch(first * CHUNK, points)?;
            let batch = first..(first + BATCH).min(chunks);
            let entries: Vec<_> = batch
                .into_par_iter()
                .map(|chunk| drawing.chunk(&game, chunk, points - chunk * CHUNK))
                .collect();
            buckets.par_chunks_mut(band).enumerate().for_each(|(number, buckets)| {
                for entry in entries.iter().flat_map(|bands| &bands[number]) {
                    buckets[entry.bucket as usize].add(palette[usize::from(entry.palette_index)]);
                }
            });
        }
        watch(points, points)?;
        Ok(Self { width, height, buckets, points })
    }

    /// Points inside the frame.
    pub fn inside(&self) -> u64 {
        self.buckets.par_iter().map(|bucket| u64::from(bucket.count)).sum()
    }

    /// How large a share of the points lies in the bucket of a usual point: the mean of `(n - 1) / (N - 1)` over the
    /// points, `Σ n (n - 1) / (N - 1) Σ n`. Of all measures of how dense a shape is this one neither changes with the
    /// number of points nor is biased by it. Stems and tips, where points pile up, are left out: buckets of more
    /// than `PILED` times the mean of the rest.
    pub fn usual_share(&self) -> f64 {
        let mut usual = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let most = PILED * usual;
            let counted = self.buckets.par_iter().map(|bucket| u128::from(bucket.count));
            let counted = counted.filter(|&count| count as f64 <= most);
            let sums = counted.map(|count| [count * count.saturating_sub(1), count]);
            let [pairs, points] = sums.reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            usual = pairs as f64 / points.max(1) as f64;
        }
        usual / self.points.saturating_sub(1).max(1) as f64
    }
}

/// How many times as dense as usual a bucket is that says nothing of the shape.
const PILED: f64 = 6.0;

/// Rounds in which such buckets are found.
const MAX_ITERATIONS: usize = 4;

impl Drawing<'_> {
    /// The points of a chunk, by bands.
    fn chunk(&self, game: &Game<'_>, chunk: u64, points: u64) -> Vec<Vec<Entry>> {
        let usual = CHUNK as usize / BANDS;
        let mut bands: Vec<Vec<Entry>> = (0..BANDS).map(|_| Vec::with_capacity(usual)).collect();
        let (mut running, mut packer) = (self.colouring.running(), self.subject.packer());
        game.chunk(chunk, points, |block| {
            if let Some(packer) = &mut packer {
                packer.pack(block);
            }
            for row in 0..block.rows().len() {
                let colours = running.row(block, row);
                let seen = self.subject.seen(block, row, packer.as_ref());
                for (seen, &colour) in seen.zip(&colours) {
                    let Some(bucket) = self.bucket(seen) else { continue };
                    let palette_index = palette::palette_index(colour, self.frame.nearness(seen[2]));
                    bands[bucket / self.band]
                        .push(Entry { bucket: (bucket % self.band) as u32, palette_index });
                }
            }
        });
        bands
    }

    /// Where a point falls; `None` outside.
    #[inline]
    fn bucket(&self, seen: [f64; 3]) -> Option<usize> {
        let fine = self.sampling.supersample as f64;
        let [x, y] = self.frame.place(seen).map(|place| place * fine);
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        inside.then(|| y as usize * self.width + x as usize)
    }
}

/// The number of points, where it and the memory are within their limits.
fn checked(frame: &Frame, sampling: Sampling) -> Result<u64, Error> {
    let fine = sampling.supersample as u64;
    let bytes = frame.pixels() * fine * fine * size_of::<Bucket>() as u64;
    let points = (frame.pixels() as f64 * sampling.samples).ceil();
    let (limit, remedy) = if bytes > MAX_BYTES {
        (Limit::new(Quantity::MemoryBytes, bytes, 0..=MAX_BYTES), "choose a smaller `size` or `supersample`")
    } else if points > MAX_POINTS {
        let limit = Limit::new(Quantity::Points, points as u64, 0..=MAX_POINTS as u64);
        (limit, "choose a smaller `size` or `samples`")
    } else {
        return Ok(points as u64);
    };
    let (Frame { width, height, .. }, samples) = (frame, sampling.samples);
    let subject =
        format!("{width} × {height} pixels with supersample {fine} and {samples} samples per pixel");
    Err(limit.of(format!("a picture of {subject}")).remedy(remedy).into())
}
