//! What the ground is asked about and answers with: points, samples, limits of its kinds, and their colours.

use super::vector::Vector;
use crate::colour::{Linear, linear_of_hex, mix};

/// Height of an eye above the ground as a share of its distance, from which crowns are seen from no lower.
const LOWEST_SIGHT: f32 = 0.25;

/// A sight from straight above.
pub(super) const UPRIGHT: Vector = [0.0, 0.0, 1.0];

/// A point of the ground that is to be coloured.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfacePoint {
    pub(super) place: [f32; 2],
    /// World coordinates; the height is the real one, above the lowest ground.
    pub(super) point: Vector,
    /// Rise over run of the ground, as it is without exaggeration.
    pub(super) slope: f32,
    /// The direction of the fall line, eastward and northward; 0 on flat ground.
    pub(super) fall: [f32; 2],
    /// Size of a pixel on the ground in metres.
    pub(super) footprint: f32,
    /// Towards the eye, without exaggeration; of any length.
    pub(super) sight: Vector,
    /// Height above the water beside it in metres, without exaggeration.
    pub(super) above: f32,
    /// Height above it up to which waves throw sand and stones.
    pub(super) beach: f32,
    /// Of the ground of the place that it is like: its height in metres, and to where it rises eastward and southward, of length 1
    /// but on flat ground.
    pub(super) bed: [f32; 3],
}

impl SurfacePoint {
    /// How the ground rises eastward and northward, without exaggeration.
    pub(super) fn rise(&self) -> [f32; 2] {
        self.fall.map(|towards| -self.slope * towards)
    }
}

/// The beds of ground of such a height and rise by the cell, with heights so many times exaggerated, as a [`SurfacePoint`] has them.
pub(super) fn bed_of([height, east, south]: [f32; 3], exaggeration: f32) -> [f32; 3] {
    let rise = (east * east + south * south).sqrt().max(1e-6);
    [height / exaggeration, east / rise, south / rise]
}

/// What light falls on.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceSample {
    /// Share of light that is sent back.
    pub(super) albedo: Linear,
    /// Slope of what is too small for the grid, eastward and northward.
    pub(super) bump: [f32; 2],
}

impl SurfacePoint {
    /// How far the line of sight goes aside for each metre that it comes nearer to the ground, from the eye's side: eastward and
    /// northward, no more than from [`LOWEST_SIGHT`].
    pub(super) fn aslant(&self) -> [f32; 2] {
        let [east, north, up] = self.sight;
        let rising = up + self.slope * (self.fall[0] * east + self.fall[1] * north);
        let least = LOWEST_SIGHT * (east * east + north * north + up * up).sqrt();
        [east, north].map(|along| along / rising.max(least))
    }
}

impl SurfaceSample {
    /// This sample, with a share of another over it.
    pub(super) fn mixed(&self, other: &Self, share: f32) -> Self {
        let bump = [0, 1].map(|axis| self.bump[axis] * (1.0 - share) + other.bump[axis] * share);
        Self { albedo: mix(self.albedo, other.albedo, share), bump }
    }
}

/// Limits of the kinds of ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Slope from which rock is bare.
    pub(super) rock: f32,
    /// Height above the lowest ground up to which trees grow, in metres.
    pub(super) trees: f32,
    /// How far woods spread below that, from 0 to 1.
    pub(super) woods: f32,
    /// Height above the lowest ground from which snow lies, in metres.
    pub(super) snow: f32,
    /// Metres from the lowest to the highest ground.
    pub(super) relief: f32,
    /// Side of a cell in metres.
    pub(super) cell: f32,
}

/// Colours of natural ground in linear light.
#[derive(Debug)]
pub(super) struct Palette {
    pub(super) lush: Linear,
    pub(super) meadow: Linear,
    pub(super) dry: Linear,
    pub(super) alpine: Linear,
    pub(super) forest: [Linear; 2],
    pub(super) rock: [Linear; 3],
    pub(super) scree: Linear,
    pub(super) gravel: Linear,
    pub(super) snow: Linear,
}

impl Default for Palette {
    fn default() -> Self {
        let [lush, meadow, dry, alpine] = [0x4d_5e2e, 0x59_6737, 0x78_7648, 0x62_683f].map(linear_of_hex);
        let forest = [0x28_3520, 0x66_783e].map(linear_of_hex);
        let rock = [0x74_7270, 0x3e_3c3a, 0x88_7d70].map(linear_of_hex);
        let [scree, gravel, snow] = [0x87_7f70, 0xa9_9d86, 0xe4_e8ee].map(linear_of_hex);
        Self { lush, meadow, dry, alpine, forest, rock, scree, gravel, snow }
    }
}
