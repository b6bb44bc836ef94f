//! What grows and lies on the ground: meadow, forest, scree, bare rock, sand and snow by slope, height, soil and
//! moisture; or the colours of the materials that a recipe names.
//!
//! The fields of the landscape say where each has its place, at the scale of cells. Noise moves the borders by less
//! than that, so that they are ragged as in nature and not smooth as a field.

use std::sync::Arc;

use super::fractures::Fractures;
use super::ground_kinds::{Limits, Palette, SurfacePoint, SurfaceSample};
use super::ground_noise::{STEEPEST, Texture, no_steeper};
use super::setting::Setting;
use super::side::Strata;
use super::site::Sites;
use super::snow::{SnowSpot, snow_share};
use super::turf::{Turf, turf};
use super::vector::{Vector, add, ramp, scale};
use crate::colour::{Linear, mix};

/// Steepness from which rock begins to be bare, and is all that there is.
const ROCK: [f32; 2] = [1.08, 1.22];

/// Light that a strand sends back beside dry gravel: sand is damp.
const STRAND: f32 = 0.66;

/// By how much rock is bare sooner on one of its blocks than on another.
const BLOCKY: f32 = 0.16;

/// Slope that bumps of bare rock come near: its faces are sharp.
pub(super) const STEEPEST_ROCK: f32 = 1.9;

/// Heath on open ground: its colour from that of withered grass to that of dark crowns, between which noise and with what share
/// of crags it grows, its greatest share, and how wet ground is on which it becomes less.
const HEATH: f32 = 0.6;
const HEATH_PATCHES: [f32; 2] = [-0.04, 0.26];
const HEATH_RIDGES: f32 = 0.6;
const HEATH_MOST: f32 = 0.5;
const HEATH_WET: [f32; 2] = [0.5, 0.9];

/// Share of a ledge that plants hide, and shares of the relief over which they vanish.
const GREEN: f32 = 0.8;
const GREEN_UP_TO: [f32; 2] = [0.55, 0.9];

/// Share of the slope of ridges and gullies that counts as that of the ground: rock is bare on their steep sides; and sides of
/// a cell in metres from which it counts, and counts whole: finer cells have theirs.
const CRAGGY: f32 = 0.6;
const CRAGGY_FROM: [f32; 2] = [4.0, 12.0];

/// What the highest ground adds to its steepness, and shares of the relief between which that grows.
const BARE: f32 = 0.4;
const BARREN: [f32; 2] = [0.45, 0.95];

/// What crests add and hollows take there, times how dry they are, and shares of the relief between which that grows.
const CRESTS: f32 = 1.1;
const SCOURED: [f32; 2] = [0.2, 0.6];

/// The ground's colours.
#[derive(Debug)]
pub(super) struct Cover {
    pub(super) sites: Sites,
    /// The materials below the ground.
    pub(super) strata: Arc<Strata>,
    pub(super) limits: Limits,
    pub(super) palette: Palette,
    /// Direction of the sun, away from which crowns throw their shadows.
    pub(super) sun: Vector,
}

impl Cover {
    /// What covers the ground of a setting under such a sun.
    pub(super) fn new(sites: Sites, setting: &Setting, sun: Vector) -> Self {
        Self {
            sites,
            strata: Arc::clone(&setting.strata),
            limits: setting.limits,
            palette: Palette::default(),
            sun,
        }
    }

    /// The colours of natural ground.
    pub(super) fn palette(&self) -> &Palette {
        &self.palette
    }

    /// Colour and roughness of a point.
    pub(super) fn at(&self, spot: &SurfacePoint) -> SurfaceSample {
        if let Some(albedo) = self.sites.material(spot.place).filter(|_| self.sites.is_draped()) {
            return SurfaceSample { albedo: albedo.map(|c| c.clamp(0.01, 0.9)), bump: [0.0; 2] };
        }
        let texture = Texture::at(spot, self.limits.cell);
        let skin = match self.sites.material(self.mingled(spot, &texture)) {
            Some(albedo) => self.of_material(spot, albedo, &texture),
            None => self.natural(spot, &texture),
        };
        // No ground in nature is darker or lighter: wet peat, fresh snow.
        SurfaceSample { albedo: skin.albedo.map(|c| c.clamp(0.01, 0.9)), bump: skin.bump }
    }

    /// 1 where rock is bare on the average: earlier in patches, and where there is less than usual soil. Trees stand by this,
    /// which is the same from near and from afar.
    pub(super) fn slope_of_cells(&self, spot: &SurfacePoint, texture: &Texture) -> f32 {
        let soil = self.sites.soil(spot.place);
        spot.slope / self.limits.rock + 0.25 * texture.patchy() + 0.4 * (0.4 - soil)
    }

    /// The same, and more on the steep sides of ridges that are finer than cells, and on high ground, where soil is thin, most
    /// on its crests.
    fn steepness(&self, spot: &SurfacePoint, texture: &Texture, moisture: f32) -> f32 {
        let [east, north] = texture.crags.slope;
        let hilly = ramp(spot.slope / self.limits.rock, 0.35, 0.8)
            * ramp(self.limits.cell, CRAGGY_FROM[0], CRAGGY_FROM[1]);
        let steeper = CRAGGY * hilly * (east * spot.fall[0] + north * spot.fall[1]);
        let high = spot.point[2] / self.limits.relief.max(1e-3) + 0.25 * texture.patchy();
        let barren = BARE * ramp(high, BARREN[0], BARREN[1])
            + CRESTS * (0.5 - moisture) * ramp(high, SCOURED[0], SCOURED[1]);
        self.slope_of_cells(spot, texture) - steeper / self.limits.rock + barren
    }

    fn natural(&self, spot: &SurfacePoint, texture: &Texture) -> SurfaceSample {
        let Texture { fine, crags, .. } = *texture;
        let patchy = texture.patchy();
        let moisture = self.sites.moisture(spot.place);
        let high = spot.point[2] / self.limits.relief.max(1e-3);
        let meadow = self.meadow(spot, texture, moisture);
        let trees = self.trees(spot, moisture, patchy);

        let [sand, washed] = Self::beach(spot, texture);
        let steep = self.steepness(spot, texture, moisture).max(ROCK[1] * washed);
        let pebbles = scale(self.palette.scree, 1.0 + 0.45 * fine.value);
        let scree = SurfaceSample { albedo: pebbles, bump: texture.rough(0.28, 0.8) };
        // Scree lies just below bare rock, never covers all, and less under trees, which hold the soil; where stones fall
        // from cliffs it does cover all.
        let fallen = self.sites.fallen(spot.place);
        let uneven = ramp(fallen, 0.0, 0.2) * (0.6 * patchy + 0.6 * fine.value - 1.2 * crags.height);
        let apron = 0.9 * ramp(1.1 * fallen + uneven, 0.4, 1.15) * ramp(spot.slope, 0.32, 0.55);
        let scree_share = (0.8 * ramp(steep, 0.97, 1.10) * (1.0 - 0.9 * ramp(trees, 0.0, 0.2))).max(apron);
        let strand = SurfaceSample {
            albedo: scale(self.palette.gravel, STRAND + 0.35 * fine.value),
            bump: texture.rough(0.1, 0.1),
        };
        let stony = meadow.mixed(&scree, scree_share).mixed(&strand, sand);
        // Rock begins where scree is whole; most ground has none.
        let blocks =
            if steep > ROCK[0] - BLOCKY { self.fractures(spot, texture, true) } else { Fractures::default() };
        let bare = ramp(steep + BLOCKY * blocks.tone, ROCK[0], ROCK[1]);
        let ground = if bare > 0.0 {
            let rock = self.rock(spot, texture, &blocks);
            let green = GREEN * blocks.ledge * (1.0 - ramp(high, GREEN_UP_TO[0], GREEN_UP_TO[1]));
            stony.mixed(&rock.mixed(&meadow, green), bare)
        } else {
            stony
        };
        let snow = SurfaceSample {
            albedo: self.palette.snow,
            bump: texture.rough(0.08, ramp(spot.slope, 0.2, 0.8)),
        };
        let wooded = self.off_cliffs(spot, texture) * trees;
        let white = self.snow(spot, texture, wooded);
        let mut open = ground.mixed(&snow, white);
        open.bump = no_steeper(open.bump, STEEPEST + (STEEPEST_ROCK - STEEPEST) * bare * (1.0 - white));
        let density = wooded * (1.0 - white) * (1.0 - sand) * (1.0 - washed);
        let conifers = self.share_of_conifers(spot.point[2]);
        if density > 0.0 { self.under_trees(spot, &open, [density, conifers]) } else { open }
    }

    /// Ground with grass on it.
    fn meadow(&self, spot: &SurfacePoint, texture: &Texture, moisture: f32) -> SurfaceSample {
        let patchy = texture.patchy();
        let high = spot.point[2] / self.limits.relief.max(1e-3);
        let wet = moisture + 0.55 * patchy;
        let grass = self.grass(wet, high + 0.25 * patchy);
        let grass = scale(grass, 1.0 + 0.3 * texture.fine.value + 0.3 * texture.crags.height);
        let heath = mix(self.palette.dry, self.palette.forest[0], HEATH);
        let grass = mix(grass, heath, self.heath(texture, wet));
        let Turf { albedo, slope } = turf(spot.point, spot.rise(), spot.footprint, [grass, self.palette.dry]);
        let bump = texture.rough(0.12, 0.8 * ramp(spot.slope, 0.1, 0.7));
        SurfaceSample { albedo, bump: [0, 1].map(|axis| bump[axis] + slope[axis]) }
    }

    /// Share of heath on open ground that is so wet.
    fn heath(&self, texture: &Texture, wet: f32) -> f32 {
        let noise = texture.fine.value + HEATH_RIDGES * texture.crags.height;
        let coarse = ramp(self.limits.cell, CRAGGY_FROM[0], CRAGGY_FROM[1]);
        let uneven = ramp(noise, HEATH_PATCHES[0], HEATH_PATCHES[1]) * coarse;
        HEATH_MOST * uneven * (1.0 - ramp(wet, HEATH_WET[0], HEATH_WET[1]))
    }

    fn grass(&self, moisture: f32, high: f32) -> Linear {
        let Palette { lush, meadow, dry, alpine, .. } = self.palette;
        // Moisture is ranked from 0 to 1, so the driest sixth is dry and the wettest lush.
        let low = mix(mix(dry, meadow, ramp(moisture, 0.15, 0.5)), lush, ramp(moisture, 0.5, 0.85));
        mix(low, mix(alpine, dry, ramp(moisture, 0.6, 0.2)), ramp(high, 0.35, 0.8))
    }

    /// Share of snow where trees stand so densely.
    pub(super) fn snow(&self, spot: &SurfacePoint, texture: &Texture, wooded: f32) -> f32 {
        let above = (spot.point[2] - self.limits.snow) / self.limits.relief.max(1e-3);
        if !above.is_finite() {
            return 0.0;
        }
        snow_share(&SnowSpot {
            above,
            slope: spot.slope,
            steepness: spot.slope / self.limits.rock,
            fall: spot.fall,
            hollow: self.sites.moisture(spot.place) - 0.5,
            noise: [texture.broad, texture.fine.value, -texture.crags.height],
            wooded,
        })
    }

    /// The bed of a lake or a river.
    pub(super) fn gravel(&self) -> Linear {
        self.palette.gravel
    }

    /// Ground of a mean colour, which sends light back into shadows.
    pub(super) fn mean(&self) -> Linear {
        self.sites.mean_material().unwrap_or_else(|| {
            let Palette { meadow, forest, rock, .. } = self.palette;
            scale(add(add(meadow, forest[1]), rock[0]), 1.0 / 3.0)
        })
    }
}
