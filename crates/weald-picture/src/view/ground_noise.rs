//! Noise of the ground, finer than cells, by which its kinds are ragged, and how steep the bumps of it may be.

use super::crags::{Crags, crags};
use super::ground_kinds::{Limits, SurfacePoint};
use super::rock::BedSpot;
use super::vector::Vector;
use weald_core::grain::{Grain, Octaves};

/// Slope that bumps come near but do not pass: from close by, many octaves would add up to needles. Crowns are rounder.
pub(super) const STEEPEST: f32 = 0.75;
pub(super) const STEEPEST_CROWN: f32 = 0.95;

/// Thickness of a bed of natural rock over the relief.
pub(super) const THICK: f32 = 0.035;

/// Noise at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Texture {
    /// Patches of many cells.
    pub(super) broad: f32,
    /// Detail finer than cells.
    pub(super) fine: Grain,
    /// Ridges and gullies finer than cells.
    pub(super) crags: Crags,
    pub(super) cell: f32,
    /// Share of the slopes of the fine detail that is left.
    evenness: f32,
}

impl Texture {
    /// The noise at a point of a landscape whose cells have such a side in metres.
    pub(super) fn at(spot: &SurfacePoint, cell: f32) -> Self {
        // Lengths are in cells, shares and limits in those of the landscape, so that a finer grid looks finer
        // and not other. All numbers here and below are chosen by eye. Patches of many cells, and detail down
        // to a fiftieth of a cell.
        let fine = Octaves { wavelength: 2.4 * cell, count: 8, gain: 0.6, seed: 0x12 };
        Self {
            broad: broad(cell).at(spot.point, spot.footprint).value,
            fine: fine.at(spot.point, spot.footprint),
            crags: crags(spot.point, spot.rise(), cell, spot.footprint),
            cell,
            evenness: evenness(spot.footprint / cell),
        }
    }

    /// Borders wander with patches more than with detail, and by half of the range of moisture.
    pub(super) fn patchy(&self) -> f32 {
        0.6 * self.broad + 0.4 * self.fine.value
    }

    /// By how many beds the edge of one is ragged.
    pub(super) fn torn(&self) -> f32 {
        0.12 * self.fine.value + 0.22 * self.crags.height
    }

    /// Slopes of the fine detail, and of ridges and gullies.
    pub(super) fn rough(&self, strength: f32, craggy: f32) -> [f32; 2] {
        [0, 1].map(|axis| {
            self.evenness * (strength * self.cell * self.fine.slope[axis] + craggy * self.crags.slope[axis])
        })
    }
}

/// The share of the slopes of fine detail that is left where a pixel is so many cells wide: each octave is two thirds as high as
/// the one before and half as long, so that the finest would hide the others from close by under scales.
fn evenness(footprint: f32) -> f32 {
    libm::powf((2.0 * footprint).clamp(0.075, 1.0), 0.4)
}

pub(super) fn no_steeper(bump: [f32; 2], steepest: f32) -> [f32; 2] {
    let square = (bump[0] * bump[0] + bump[1] * bump[1]) / (steepest * steepest);
    bump.map(|slope| slope / (1.0 + square).sqrt())
}

/// Patches of many cells.
fn broad(cell: f32) -> Octaves {
    Octaves { wavelength: 26.0 * cell, count: 5, gain: 0.55, seed: 0x11 }
}

/// Patches of many cells at many points, which are used up.
pub(super) fn broad_values(places: [&mut [f32]; 2], cell: f32) -> Vec<f32> {
    broad(cell).values(places, 0.0)
}

/// Some thirty beds over the relief, folded by about one of their thickness, at a point where patches have such a value.
pub(super) fn bed_spot(point: Vector, limits: &Limits, broad: f32) -> BedSpot {
    BedSpot { point, fold: 1.4 * broad, thickness: THICK * limits.relief.max(1e-3), footprint: 0.0 }
}
