//! Diamond-square: midpoint displacement on a square lattice that doubles at every level.
//!
//! From a lattice of step `s` the centre of each square becomes the mean of its four corners (diamond step),
//! then the middle of each edge the mean of its two ends and the two centres beside it (square step; at the
//! border the mean of three), each plus a random number in `±a_l`. Level `l` counts from 0 and
//!
//! ```text
//! a_l = 2^(-H l)      H = `roughness`; corners are random in ±1
//! ```
//!
//! Fournier, Fussell, Carpenter 1982, doi 10.1145/358523.358553; Miller 1986, doi 10.1145/15922.15899.
//!
//! What differs: the random numbers are hashes of (seed, level, place), so the order of points does not
//! matter and a lattice twice as fine has the same large shapes. The lattice has `2^m + 1` points a side, the
//! least that covers the landscape, and only the part under the landscape is computed: each level is a window
//! of the level below it, kept as rows without gaps.

mod program;

use rayon::prelude::*;

use super::hash::Plane;
use super::relief;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::vectors;
use weald_engine::generator::Generator;
use weald_engine::on_device::OnDevice;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<DiamondSquare>(
    "diamond-square",
    Stage::Generate,
    "mountains by midpoint displacement on a lattice that doubles at every level",
    "Fournier, Fussell, Carpenter 1982; Miller 1986",
);

parameters! {
    /// Midpoint displacement.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::diamond_square::DiamondSquare;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(48, 32)?, 10.0)); // columns, rows, metres
    /// DiamondSquare { relief: 300.0, ..DiamondSquare::default() }.run(&mut landscape, &Job::unwatched(7))?;
    /// let (lowest, highest) = landscape.field("height")?.range(None).expect("there are cells");
    /// assert!((highest - lowest - 300.0).abs() < 0.001, "from {lowest} to {highest} m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct DiamondSquare {
        /// Height between the lowest and the highest point.
        relief: f64 = 1000.0, range 0.0..=1.0e6, unit "m";
        /// Amplitude is multiplied by 2^-roughness at every level: 1 is smooth, 0.5 rugged.
        roughness: f64 = 0.9, range 0.0..=2.0;
        /// A seed of its own. Without it the landscape's is used, varied for each step.
        seed: Option<u64> = None, range 0..=9_007_199_254_740_991_i64;
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for DiamondSquare {
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error> {
        let levels = levels(domain.size);
        let windows = windows(domain.size, levels);
        let mut lattice = corners(windows[0], seed);
        for (level, &window) in (0..levels).zip(&windows[1..]) {
            let refinement = Refinement {
                amplitude: self.amplitude(level),
                random: Plane::new(seed, u64::from(level) + 1),
                side: 2 << level,
            };
            lattice = refinement.refined(&lattice, window);
        }
        relief::rescale(&mut lattice, self.relief as f32);
        Ok(lattice)
    }

    fn on_device(&self, domain: &Domain, seed: u64) -> Option<OnDevice> {
        Some(self.lattice(domain.size, seed))
    }

    fn finish(&self, domain: &Domain, made: Vec<f32>) -> Field {
        let mut lattice = Field::from_values(domain.size, made[..domain.size.cells()].to_vec());
        relief::rescale(&mut lattice, self.relief as f32);
        lattice
    }

    fn target(&self) -> &LayerName {
        &self.into
    }

    fn own_seed(&self) -> Option<u64> {
        self.seed
    }
}

impl DiamondSquare {
    fn amplitude(&self, level: u32) -> f32 {
        libm::exp2(-self.roughness * f64::from(level)) as f32
    }
}

/// Doublings until the lattice covers the size.
fn levels(size: Size) -> u32 {
    let steps = size.columns.max(size.rows).max(2) - 1;
    steps.next_power_of_two().trailing_zeros()
}

/// The part of every level's lattice that the levels above it need, from the corners to the landscape itself.
fn windows(size: Size, levels: u32) -> Vec<Size> {
    let mut windows = vec![size];
    for level in (0..levels).rev() {
        let finer = windows[windows.len() - 1];
        // The last row's edges need the centres beyond it, and these the next coarse row, unless the lattice
        // ends.
        let coarser = |points: usize| ((points - 1) / 2 + 2).min((1 << level) + 1);
        windows.push(Size { columns: coarser(finer.columns), rows: coarser(finer.rows) });
    }
    windows.reverse();
    windows
}

fn corners(window: Size, seed: u64) -> Field {
    let random = Plane::new(seed, 0);
    Field::from_function(window, |x, y| random.signed(x as i32, y as i32))
}

/// Pairs of rows that one task makes. The first of them repeats one row of centres of the task above.
const PAIRS_PER_TASK: usize = 16;

/// One doubling of the lattice.
struct Refinement {
    amplitude: f32,
    random: Plane,
    /// Intervals along a side of the finer lattice.
    side: usize,
}

impl Refinement {
    fn refined(&self, coarse: &Field, window: Size) -> Field {
        let mut fine = Field::filled(window, 0.0);
        let rows_per_task = 2 * PAIRS_PER_TASK;
        fine.values_mut().par_chunks_mut(rows_per_task * window.columns).enumerate().for_each(
            |(task, band)| {
                vectors::widest(
                    #[inline(always)]
                    || self.refine_band(coarse, task * rows_per_task, window.columns, band),
                );
            },
        );
        fine
    }

    /// Rows from an even `first` on: even rows hold coarse points and edge middles, odd ones edge middles and
    /// centres.
    #[inline(always)]
    fn refine_band(&self, coarse: &Field, first: usize, columns: usize, band: &mut [f32]) {
        let mut above = vec![0.0; coarse.size().columns - 1];
        let mut below = above.clone();
        if first > 0 {
            self.centres(coarse, first / 2 - 1, &mut above);
        }
        for (y, rows) in (first..).step_by(2).zip(band.chunks_mut(2 * columns)) {
            let (even, odd) = rows.split_at_mut(columns);
            if y < self.side {
                self.centres(coarse, y / 2, &mut below);
            } else {
                below.fill(0.0);
            }
            self.even_row(y, coarse.row(y / 2), [&above, &below], even);
            if !odd.is_empty() {
                self.odd_row(y + 1, [coarse.row(y / 2), coarse.row(y / 2 + 1)], &below, odd);
            }
            std::mem::swap(&mut above, &mut below);
        }
    }

    /// Centres of the squares between coarse rows `y` and `y + 1`.
    #[inline(always)]
    fn centres(&self, coarse: &Field, y: usize, centres: &mut [f32]) {
        let count = centres.len();
        let [north, south] = [coarse.row(y), coarse.row(y + 1)];
        let (north_east, south_east) = (&north[1..][..count], &south[1..][..count]);
        for x in 0..count {
            let mean = ((north[x] + north_east[x]) + (south[x] + south_east[x])) * 0.25;
            centres[x] = mean + self.offset(2 * x + 1, 2 * y + 1);
        }
    }

    /// Coarse points in even columns, middles of their edges in odd ones. Beyond the border `beside` is 0.
    #[inline(always)]
    fn even_row(&self, y: usize, coarse: &[f32], beside: [&[f32]; 2], row: &mut [f32]) {
        let share = if y == 0 || y == self.side { 1.0 / 3.0 } else { 0.25 };
        let (pairs, last) = row.as_chunks_mut::<2>();
        let count = pairs.len();
        let (east, [above, below]) = (&coarse[1..][..count], beside.map(|centres| &centres[..count]));
        for (x, pair) in pairs.iter_mut().enumerate() {
            let mean = ((coarse[x] + east[x]) + (above[x] + below[x])) * share;
            *pair = [coarse[x], mean + self.offset(2 * x + 1, y)];
        }
        if let [last] = last {
            *last = coarse[count];
        }
    }

    /// Middles of edges in even columns, centres in odd ones.
    #[inline(always)]
    fn odd_row(&self, y: usize, coarse: [&[f32]; 2], centres: &[f32], row: &mut [f32]) {
        let [north, south] = coarse;
        let middle = |x: usize, west: f32, east: f32, share: f32| {
            ((north[x] + south[x]) + (west + east)) * share + self.offset(2 * x, y)
        };
        let (pairs, last) = row.as_chunks_mut::<2>();
        let count = pairs.len();
        if let Some((first, inner)) = pairs.split_first_mut() {
            *first = [middle(0, 0.0, centres[0], 1.0 / 3.0), centres[0]];
            let (west, east) = (&centres[..count - 1], &centres[1..count]);
            for (x, pair) in inner.iter_mut().enumerate() {
                *pair = [middle(x + 1, west[x], east[x], 0.25), east[x]];
            }
        }
        if let [last] = last {
            let west = if count > 0 { centres[count - 1] } else { 0.0 };
            let east = if 2 * count < self.side { centres[count] } else { 0.0 };
            let border = count == 0 || 2 * count == self.side;
            let share = if border { 1.0 / 3.0 } else { 0.25 };
            *last = middle(count, west, east, share);
        }
    }

    #[inline(always)]
    fn offset(&self, column: usize, row: usize) -> f32 {
        self.random.signed(column as i32, row as i32) * self.amplitude
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(roughness: f64) -> DiamondSquare {
        DiamondSquare { roughness, ..DiamondSquare::default() }
    }

    fn filled(step: &DiamondSquare, columns: usize, rows: usize, seed: u64) -> Field {
        let size = Size::new(columns, rows).expect("small");
        step.fill(&Domain::new(size, 1.0), seed).expect("any grid will do")
    }

    /// The method as published: on the whole lattice, point by point.
    fn naive(roughness: f64, levels: u32, seed: u64) -> Vec<Vec<f32>> {
        let side = 1_usize << levels;
        let mut z = vec![vec![0.0_f32; side + 1]; side + 1];
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            z[y * side][x * side] = Plane::new(seed, 0).signed(x as i32, y as i32);
        }
        for level in 0..levels {
            let half = side >> (level + 1);
            let amplitude = libm::exp2(-roughness * f64::from(level)) as f32;
            let random = |x: usize, y: usize| {
                Plane::new(seed, u64::from(level) + 1).signed((x / half) as i32, (y / half) as i32)
                    * amplitude
            };
            for (y, x) in places(side, half).filter(|(y, x)| y % (2 * half) != 0 && x % (2 * half) != 0) {
                let corners = (z[y - half][x - half] + z[y - half][x + half])
                    + (z[y + half][x - half] + z[y + half][x + half]);
                z[y][x] = corners * 0.25 + random(x, y);
            }
            for (y, x) in places(side, half).filter(|(y, x)| (y / half + x / half) % 2 == 1) {
                let horizontal = [x.checked_sub(half).map(|west| z[y][west]), z[y].get(x + half).copied()];
                let vertical = [y.checked_sub(half).map(|up| z[up][x]), z.get(y + half).map(|row| row[x])];
                let sum = |two: [Option<f32>; 2]| two[0].unwrap_or(0.0) + two[1].unwrap_or(0.0);
                let there = horizontal.iter().chain(&vertical).flatten().count();
                let share = if there == 3 { 1.0 / 3.0 } else { 0.25 };
                z[y][x] = (sum(horizontal) + sum(vertical)) * share + random(x, y);
            }
        }
        z
    }

    fn places(side: usize, step: usize) -> impl Iterator<Item = (usize, usize)> {
        let line = move || (0..=side).step_by(step);
        line().flat_map(move |y| line().map(move |x| (y, x)))
    }

    #[test]
    fn windows_of_any_shape_hold_the_heights_of_the_whole_lattice() {
        let whole = naive(0.7, 6, 5);
        for (columns, rows) in [(65, 65), (64, 64), (50, 65), (65, 33), (34, 3), (63, 1), (1, 40), (48, 47)] {
            let lowest = |z: f32, other: f32| if other < z { other } else { z };
            let part: Vec<f32> = whole[..rows].iter().flat_map(|row| row[..columns].to_vec()).collect();
            let (low, high) =
                (part.iter().copied().fold(f32::MAX, lowest), part.iter().copied().fold(f32::MIN, f32::max));
            let field = filled(&steps(0.7), columns, rows, 5);
            for (made, reference) in field.values().iter().zip(&part) {
                let expected = (reference - low) / (high - low) * 1000.0;
                assert!((made - expected).abs() < 1e-3, "{columns} × {rows}: {made}, not {expected}");
            }
        }
    }

    #[test]
    fn a_grid_of_any_size_spans_exactly_the_relief() {
        for (columns, rows) in [(2, 2), (3, 3), (257, 256), (100, 7), (2, 300)] {
            let field = filled(&steps(0.9), columns, rows, 1);
            assert_eq!(field.range(None), Some((0.0, 1000.0)), "{columns} × {rows}");
        }
        assert_eq!(filled(&steps(0.9), 1, 1, 1).values(), [0.0]);
    }

    #[test]
    fn a_lattice_twice_as_fine_has_the_same_large_shapes() {
        let [coarse, fine] = [65, 129].map(|side| filled(&steps(0.9), side, side, 9));
        let corner = |field: &Field| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
                let last = field.size().columns - 1;
                field.at(x * last, y * last)
            })
        };
        let differences = corner(&coarse).into_iter().zip(corner(&fine)).map(|(a, b)| (a - b).abs());
        assert!(differences.fold(0.0, f32::max) < 20.0, "metres of 1000; only the ends of the range moved");
    }

    #[test]
    fn roughness_sets_how_height_differences_grow_with_distance() {
        for roughness in [0.5, 0.9] {
            let field = filled(&steps(roughness), 513, 513, 2);
            let structure = |apart: usize| {
                let rows = (0..513).flat_map(|y| (0..513 - apart).map(move |x| (x, y)));
                let squares = rows.map(|(x, y)| f64::from(field.at(x + apart, y) - field.at(x, y)).powi(2));
                squares.sum::<f64>() / (513.0 * (513 - apart) as f64)
            };
            let exponent = 0.5 * (structure(16) / structure(2)).log2() / 3.0;
            assert!((exponent - roughness).abs() < 0.12, "{roughness}: {exponent}");
        }
    }
}
