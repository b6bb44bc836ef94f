//! Blurs a layer by a Gaussian, rows first, then columns.
//!
//! ```text
//! v'(p) = Σ g(|p - q|) v(q) / Σ g(|p - q|)        over cells q with data, g(r) = exp(-r² / 2 radius²)
//! ```
//!
//! The sum ends at three radii. Dividing by the weights of the cells that take part keeps flat ground level
//! at the edges of the grid and of the data ("normalised convolution", Knutsson and Westin 1993, doi
//! 10.1109/CVPR.1993.341081).

use rayon::prelude::*;

use super::{store, written};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::vectors;
use weald_engine::Job;
use weald_engine::local::{self, LocalWork, Reach};
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::stored::StoredLandscape;

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Smooth>("smooth", Stage::Combine, "blurs a layer by a Gaussian", "Knutsson and Westin 1993");

/// Radii at which the Gaussian is cut off.
const REACH: f64 = 3.0;

parameters! {
    /// Gaussian blur.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::smooth::Smooth;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// let rough = |x, y| 100.0 + if (x + y) % 2 == 0 { 5.0 } else { -5.0 };
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, rough));
    /// Smooth { radius: 10.0, ..Smooth::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert!((landscape.field("height")?.at(4, 3) - 100.0).abs() < 0.5, "forms much shorter than 60 m are gone");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Smooth {
        /// Layer that is read.
        layer: LayerName = LayerName::of("height");
        /// Standard deviation of the Gaussian. Forms much shorter than six of it vanish.
        radius: f64 = 50.0, range 0.0..=1.0e6, unit "m";
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

impl Step for Smooth {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        written(self.into.as_ref(), &self.layer)
    }

    fn reach(&self) -> Option<Reach> {
        // The radius in cells is rounded before it is multiplied.
        Some(Reach { metres: REACH * self.radius, cells: 1 })
    }

    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        let (low, weights) = (landscape.range(&self.layer.0)?.0, self.weights_on(&landscape.domain));
        let reach = Reach { metres: 0.0, cells: weights.len() - 1 };
        let work = LocalWork::of((self.reads(), self.writes()), (reach, self.bytes_per_cell()));
        local::run(&work, landscape, job, &|part| self.run_above(low, &weights, part))?;
        Ok(Outcome::default())
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let low = landscape.field(&self.layer.0)?.range(domain.valid.as_ref()).map_or(0.0, |(low, _)| low);
        let weights = self.weights_on(domain);
        self.run_above(low, &weights, landscape)?;
        Ok(Outcome::default())
    }
}

impl Smooth {
    /// Weights of the cells of such a grid by their distance.
    fn weights_on(&self, domain: &Domain) -> Vec<f32> {
        weights(self.radius / domain.cell, domain.size.columns.max(domain.size.rows))
    }

    /// Blurs above the lowest value of the whole.
    fn run_above(&self, low: f32, weights: &[f32], landscape: &mut Landscape) -> Result<(), Error> {
        let field = landscape.field(&self.layer.0)?;
        let smooth = smoothed(field, low, landscape.domain.valid.as_ref(), weights);
        store(landscape, &self.layer, self.into.as_ref(), smooth)
    }
}

/// Weight of a cell by its distance, 0 to the reach or the end of the grid.
fn weights(radius: f64, longest: usize) -> Vec<f32> {
    let reach = (libm::ceil(REACH * radius) as usize).min(longest - 1);
    let weight = |distance: usize| {
        let share = distance as f64 / radius.max(1e-9);
        libm::exp(-0.5 * share * share) as f32
    };
    (0..=reach).map(weight).collect()
}

/// Heights are blurred above the lowest, so that a high plateau loses no digits and flat ground is exact.
fn smoothed(field: &Field, low: f32, valid: Option<&Mask>, weights: &[f32]) -> Field {
    let share = |index: usize| if valid.is_none_or(|valid| valid.is_valid_at(index)) { 1.0 } else { 0.0 };
    let cells = 0..field.values().len();
    let size = field.size();
    let values =
        cells.clone().map(|index| if share(index) > 0.0 { field.values()[index] - low } else { 0.0 });
    let heights = blurred(&Field::from_values(size, values.collect()), weights);
    let shares = blurred(&Field::from_values(size, cells.clone().map(share).collect()), weights);
    let value = |index: usize| {
        let old = field.values()[index];
        if share(index) > 0.0 { low + heights.values()[index] / shares.values()[index] } else { old }
    };
    Field::from_values(size, cells.map(value).collect())
}

fn blurred(field: &Field, weights: &[f32]) -> Field {
    let along_rows = by_rows(field, |y, row| blur_along(field.row(y), weights, row));
    by_rows(&along_rows, |y, row| blur_across(&along_rows, y, weights, row))
}

fn by_rows(like: &Field, fill: impl Fn(usize, &mut [f32]) + Sync) -> Field {
    let mut field = Field::filled(like.size(), 0.0);
    field.values_mut().par_chunks_mut(like.size().columns).enumerate().for_each(|(y, row)| fill(y, row));
    field
}

fn blur_along(row: &[f32], weights: &[f32], out: &mut [f32]) {
    add_scaled(out, row, weights[0]);
    let columns = row.len();
    for (apart, &weight) in weights.iter().enumerate().skip(1).take(columns - 1) {
        add_scaled(&mut out[apart..], &row[..columns - apart], weight);
        add_scaled(&mut out[..columns - apart], &row[apart..], weight);
    }
}

fn blur_across(field: &Field, y: usize, weights: &[f32], out: &mut [f32]) {
    add_scaled(out, field.row(y), weights[0]);
    for (apart, &weight) in weights.iter().enumerate().skip(1) {
        let above = y.checked_sub(apart);
        let below = Some(y + apart).filter(|&y| y < field.size().rows);
        for there in [above, below].into_iter().flatten() {
            add_scaled(out, field.row(there), weight);
        }
    }
}

fn add_scaled(out: &mut [f32], row: &[f32], weight: f32) {
    vectors::widest(
        #[inline(always)]
        || {
            for (sum, value) in out.iter_mut().zip(row) {
                *sum += weight * value;
            }
        },
    );
}
