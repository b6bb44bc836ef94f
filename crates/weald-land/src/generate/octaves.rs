//! The sum of noise at shrinking wavelengths that `fbm`, `ridged` and `warp` share.
//!
//! Octave `k` has wavelength `λ / lacunarity^k` and amplitude `gain^k`. All lengths are in metres, so a
//! recipe makes the same ground at any resolution.

mod program;

pub(crate) use program::OctavePass;

use std::ops::Range;

use rayon::prelude::*;

use super::noise::{Octave, VARIANCE, Window};
use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};
use weald_core::vectors;

/// Wavelengths and amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    /// How many wavelengths.
    pub octaves: u32,
    /// The longest, in metres.
    pub wavelength: f64,
    /// Amplitude of each relative to the one before.
    pub gain: f64,
    /// How many times shorter each is than the one before.
    pub lacunarity: f64,
}

impl Spectrum {
    /// The octaves over a window, each with its amplitude; the first has 1.
    pub fn over(&self, window: &Window, seed: u64) -> Vec<(Octave, f32)> {
        let (mut wavelength, mut amplitude) = (self.wavelength, 1.0);
        let octave = |index: u32| {
            let made = (Octave::new(window, wavelength, seed, index), amplitude as f32);
            wavelength /= self.lacunarity;
            amplitude *= self.gain;
            made
        };
        (0..self.octaves).map(octave).collect()
    }

    /// Standard deviation of the sum; that of one octave of amplitude 1 is `sqrt(VARIANCE)`.
    pub fn deviation(&self) -> f64 {
        libm::sqrt(VARIANCE * self.amplitudes().map(|amplitude| amplitude * amplitude).sum::<f64>())
    }

    /// Sum of all amplitudes: no place is higher or lower.
    pub fn bound(&self) -> f64 {
        self.amplitudes().sum()
    }

    fn amplitudes(&self) -> impl Iterator<Item = f64> {
        std::iter::successors(Some(1.0), |amplitude| Some(amplitude * self.gain)).take(self.octaves as usize)
    }
}

/// The window that a landscape is.
pub fn window(domain: &Domain) -> Window {
    Window { first: [0, 0], count: [domain.size.columns, domain.size.rows], cell: domain.cell }
}

/// Some rows of a landscape as one of their own, and the window that they are.
pub fn part(domain: &Domain, rows: Range<usize>) -> (Domain, Window) {
    let size = Size { columns: domain.size.columns, rows: rows.len() };
    let part = Domain { size, ..Domain::new(size, domain.cell) };
    let window = Window { first: [0, rows.start as i64], ..window(&part) };
    (part, window)
}

/// Rows that one task makes.
const ROWS_PER_TASK: usize = 16;

/// Makes a field row by row on all threads, in the widest vectors of the machine. `row` is given the number
/// of the row and its cells, all 0.
pub fn fill_rows<R>(domain: &Domain, row: R) -> Field
where
    R: Fn(usize, &mut [f32]) + Sync,
{
    let columns = domain.size.columns;
    let mut field = Field::filled(domain.size, 0.0);
    field.values_mut().par_chunks_mut(columns * ROWS_PER_TASK).enumerate().for_each(|(task, band)| {
        let row = &row;
        vectors::widest(
            #[inline(always)]
            || {
                for (y, cells) in (task * ROWS_PER_TASK..).zip(band.chunks_exact_mut(columns)) {
                    row(y, cells);
                }
            },
        );
    });
    field
}
