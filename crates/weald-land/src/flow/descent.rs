//! Steepest descent: the neighbour among eight to which the ground drops most by length.
//!
//! Of two drops that are the same the first of the codes wins. Whole rows are compared at once.

use rayon::prelude::*;

use super::surface::{NO_DATA, ROWS_PER_TASK, Surface};
use crate::flow::directions::{OUTLET, STEPS};
use weald_core::vectors;

/// Code of a cell that has no lower neighbour and is no outlet.
pub(super) const FLAT: u8 = 16;

/// The code of each cell, with the ring: 1 to 8 downhill, [`FLAT`], or [`OUTLET`] where water leaves, in the
/// sea and without data.
#[derive(Debug)]
pub(super) struct Descent {
    pub(super) codes: Vec<u8>,
}

impl Descent {
    pub(super) fn of(surface: &Surface) -> Self {
        let stride = surface.stride;
        let mut codes = vec![OUTLET; surface.cells()];
        let rows = codes.par_chunks_mut(stride).enumerate().skip(1).take(surface.size.rows);
        rows.with_min_len(ROWS_PER_TASK).for_each_init(
            || Row::new(surface.size.columns),
            |row, (y, codes)| {
                let rows = [y - 1, y, y + 1].map(|y| &surface.level[y * stride..][..stride]);
                row.compare(rows);
                let here = &rows[1][1..];
                for (x, code) in codes[1..].iter_mut().enumerate().take(surface.size.columns) {
                    *code = match row.code[x] {
                        _ if here[x].is_infinite() => OUTLET,
                        0.0 if row.highest[x] == NO_DATA => OUTLET,
                        0.0 => FLAT,
                        code => code as u8,
                    };
                }
            },
        );
        Self { codes }
    }
}

/// What is known of a row while its neighbours are looked at. Codes are floats, so that all lanes are alike.
struct Row {
    drop: Vec<f32>,
    code: Vec<f32>,
    highest: Vec<f32>,
}

impl Row {
    fn new(columns: usize) -> Self {
        let empty = || vec![0.0; columns];
        Self { drop: empty(), code: empty(), highest: empty() }
    }

    fn compare(&mut self, rows: [&[f32]; 3]) {
        self.drop.fill(0.0);
        self.code.fill(0.0);
        self.highest.fill(f32::NEG_INFINITY);
        vectors::widest(
            #[inline(always)]
            || {
                for (index, (east, south)) in STEPS.into_iter().enumerate() {
                    let there = &rows[(1 + south) as usize][(1 + east) as usize..];
                    let nearness =
                        if east != 0 && south != 0 { std::f32::consts::FRAC_1_SQRT_2 } else { 1.0 };
                    self.look(&rows[1][1..], there, (index + 1) as f32, nearness);
                }
            },
        );
    }

    #[inline(always)]
    fn look(&mut self, here: &[f32], there: &[f32], code: f32, nearness: f32) {
        let best = self.drop.iter_mut().zip(&mut self.code).zip(&mut self.highest);
        for (((best, best_code), highest), (&here, &there)) in best.zip(here.iter().zip(there)) {
            let drop = (here - there) * nearness;
            let better = drop > *best;
            *best = if better { drop } else { *best };
            *best_code = if better { code } else { *best_code };
            *highest = if there > *highest { there } else { *highest };
        }
    }
}
