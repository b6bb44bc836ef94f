//! Upslope sums where each cell shares what it has among all lower neighbours.
//!
//! ```text
//! share of neighbour i = S_i^p / Σ S_j^p       S = drop over distance, for all lower neighbours
//! ```
//!
//! Freeman 1991, "Calculating catchment area with divergent flow based on a regular grid", doi
//! 10.1016/0098-3004(91)90048-I: p = 1.1 spreads water over a cone evenly in all directions. p = 1 without its
//! contour lengths is the rule of Quinn et al. 1991 (doi 10.1002/hyp.3360050106); large p comes near D8. Over
//! flat ground water follows the D8 directions.

use super::Routed;
use crate::exponential::power;
use crate::flow::directions::STEPS;
use weald_core::grid::{Mask, Size};

/// Flow that divides.
#[derive(Clone, Copy, Debug)]
pub struct MultipleFlow<'a> {
    /// Ground without depressions, and its D8 directions.
    pub routed: &'a Routed,
    /// Cells with data.
    pub valid: Option<&'a Mask>,
    /// The exponent p: 0 shares evenly among lower neighbours, large numbers favour the steepest.
    pub exponent: f64,
}

impl MultipleFlow<'_> {
    /// The share of each neighbour of a cell, by direction from east over south; all 0 at outlets and in the
    /// sea.
    #[inline(always)]
    pub fn shares(&self, cell: usize) -> [f64; 8] {
        let mut weights = self.weights(cell);
        let sum: f64 = weights.iter().sum();
        if sum > 0.0 {
            // Not `map`, which is a call for each.
            for weight in &mut weights {
                *weight /= sum;
            }
        }
        weights
    }

    /// What the shares are in proportion to.
    #[inline(always)]
    pub(super) fn weights(&self, cell: usize) -> [f64; 8] {
        if self.routed.directions.downstream(cell).is_none() {
            return [0.0; 8];
        }
        let mut weights = self.descents(cell);
        weigh(&mut weights, self.exponent);
        if weights.iter().all(|&weight| weight == 0.0) {
            weights[usize::from(self.routed.directions.codes()[cell]) - 1] = 1.0;
        }
        weights
    }

    /// Drop over distance to each neighbour, by direction; 0 where there is none.
    #[inline(always)]
    fn descents(&self, cell: usize) -> [f64; 8] {
        let Size { columns, rows } = self.routed.surface.size();
        let [x, y] = [cell % columns, cell / columns];
        let is_inside = x > 0 && y > 0 && x + 1 < columns && y + 1 < rows && self.valid.is_none();
        let mut descents = [0.0; 8];
        for (direction, descent) in descents.iter_mut().enumerate() {
            let (east, south) = STEPS[direction];
            let beside = cell.wrapping_add_signed(south * columns as isize + east);
            let other = if is_inside { Some(beside) } else { self.neighbour(cell, direction) };
            *descent = other.map_or(0.0, |other| self.descent(cell, other, direction));
        }
        descents
    }

    #[inline(always)]
    pub(super) fn descent(&self, cell: usize, other: usize, direction: usize) -> f64 {
        let level = self.routed.surface.values();
        (f64::from(level[cell]) - f64::from(level[other])) * Self::nearness(direction)
    }

    /// One over the distance to a neighbour in a direction, in cells.
    #[inline(always)]
    pub(super) fn nearness(direction: usize) -> f64 {
        if direction % 2 == 1 { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 }
    }

    pub(super) fn neighbour(&self, cell: usize, direction: usize) -> Option<usize> {
        let Size { columns, rows } = self.routed.surface.size();
        let (east, south) = STEPS[direction];
        let x = (cell % columns).wrapping_add_signed(east);
        let y = (cell / columns).wrapping_add_signed(south);
        let other = y.wrapping_mul(columns).wrapping_add(x);
        (x < columns && y < rows && self.valid.is_none_or(|valid| valid.is_valid_at(other))).then_some(other)
    }
}

/// Weights in place of the drops to all neighbours over their distances.
#[inline(always)]
pub(super) fn weigh(descents: &mut [f64; 8], exponent: f64) {
    for descent in descents {
        *descent = weight(*descent, exponent);
    }
}

/// What the share of a neighbour is in proportion to, by the drop to it over the distance.
#[inline(always)]
pub(super) fn weight(descent: f64, exponent: f64) -> f64 {
    let weight = power(descent, exponent);
    if descent > 0.0 { weight } else { 0.0 }
}
