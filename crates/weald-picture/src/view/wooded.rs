//! Where trees of natural ground stand, how densely and of which kind.

use super::cover::Cover;
use super::crown_relief::seen_crown;
use super::ground_kinds::{SurfacePoint, SurfaceSample};
use super::ground_noise::{STEEPEST_CROWN, Texture, no_steeper};
use super::vector::{filter, ramp, scale};
use super::woods::{Canopy, canopy};
use crate::colour::{Linear, mix};

/// Steepness from which trees become fewer, and from which there are none.
const CLIFF: [f32; 2] = [0.72, 1.08];

/// Light that needles and leaves send back beside that of a wood.
const NEEDLES: Linear = [0.66, 0.79, 0.95];
const LEAVES: Linear = [1.08, 1.05, 0.84];

/// How far below the tree line leaves take the place of needles, in widths of the belt in which trees become fewer, and the
/// greatest share of trees with leaves.
const LEAVED: [f32; 2] = [0.3, 2.2];
const MOST_LEAVES: f32 = 0.85;

/// Height in metres above the water, and at most that share of a cell, from which trees stand.
const SHORE: [f32; 2] = [2.5, 0.028];

/// How much higher the score of trees is where woods spread everywhere than where nowhere: more than moisture makes of it.
const SPREAD: f32 = 2.8;

/// Spread of woods below which trees become fewer, down to none.
const FEW: f32 = 0.1;

/// How densely lone trees stand before a wood.
const LONE: f32 = 0.1;

impl Cover {
    /// How densely trees stand at a point of natural ground, from 0 to 1, and the share of conifers among them.
    pub(super) fn wood(&self, spot: &SurfacePoint) -> [f32; 2] {
        let texture = Texture::at(spot, self.limits.cell);
        let trees = self.trees(spot, self.sites.moisture(spot.place), texture.patchy());
        let [sand, washed] = Self::beach(spot, &texture);
        let wooded = trees * self.off_cliffs(spot, &texture);
        let density = wooded * (1.0 - self.snow(spot, &texture, wooded)) * (1.0 - sand) * (1.0 - washed);
        [density, self.share_of_conifers(spot.point[2])]
    }

    /// The share of trees that cliffs bear beside other ground.
    pub(super) fn off_cliffs(&self, spot: &SurfacePoint, texture: &Texture) -> f32 {
        1.0 - ramp(self.slope_of_cells(spot, texture), CLIFF[0], CLIFF[1])
    }

    /// The share of conifers at a height.
    pub(super) fn share_of_conifers(&self, height: f32) -> f32 {
        1.0 - MOST_LEAVES * ramp(self.below_tree_line(height), LEAVED[0], LEAVED[1])
    }

    /// Ground with a wood of such a density and share of conifers on it.
    pub(super) fn under_trees(
        &self,
        spot: &SurfacePoint,
        open: &SurfaceSample,
        [density, conifers]: [f32; 2],
    ) -> SurfaceSample {
        let [east, north, _] = spot.point;
        let Canopy { share, tone, slope, open: left, chance } = canopy(
            seen_crown([east, north], [density, spot.footprint], spot.aslant()),
            density,
            spot.footprint,
            self.sun,
        );
        let [dark, light] = self.palette.forest;
        let shaded = SurfaceSample { albedo: scale(open.albedo, left), bump: open.bump };
        let kind = mix(LEAVES, NEEDLES, ramp(conifers - chance, -0.08, 0.08));
        let wood = SurfaceSample {
            albedo: filter(kind, mix(dark, light, tone.clamp(0.0, 1.0))),
            bump: no_steeper(slope, STEEPEST_CROWN),
        };
        shaded.mixed(&wood, share)
    }

    /// How densely trees stand: where it is moist but not boggy, below the tree line, not too steep, and above the shore.
    pub(super) fn trees(&self, spot: &SurfacePoint, moisture: f32, patchy: f32) -> f32 {
        let line = self.below_tree_line(spot.point[2]);
        let steep = ramp(spot.slope / self.limits.rock, 0.95, 1.3);
        // A score: moisture first, then patches; height below the tree line helps a little and cannot make up
        // for drought.
        let wood =
            1.1 * (moisture - 0.5) + 0.9 * patchy + 0.4 * line.clamp(-8.0, 0.8) - 0.4 * steep + self.spread();
        let [metres, share] = SHORE;
        // Woods thin out at their edges, and a few trees stand far off.
        let density = ramp(wood, 0.02, 0.52).max(LONE * ramp(wood, -0.7, 0.1));
        let few = (self.limits.woods / FEW).min(1.0);
        few * density * ramp(spot.above, 0.0, metres.min(share * self.limits.cell))
    }

    /// How far below the tree line a height is, in widths of the belt in which trees become fewer.
    pub(super) fn below_tree_line(&self, height: f32) -> f32 {
        (self.limits.trees - height) / (0.12 * self.limits.relief).max(1e-3)
    }

    /// Whether ground of this height may bear trees.
    pub(super) fn has_woods(&self) -> bool {
        // The score of the best place, at the lowest ground.
        let line = self.below_tree_line(0.0);
        !self.sites.shows_materials()
            && self.limits.woods > 0.0
            && 1.2 + 0.4 * line.clamp(-8.0, 0.8) + self.spread() > 0.02
    }

    /// What the spread of woods adds to the score of trees.
    fn spread(&self) -> f32 {
        SPREAD * (self.limits.woods - 0.5)
    }
}
