//! What grows and lies on the ground: meadow, forest, scree, bare rock, sand and snow by slope, height, soil and
//! moisture; or the colours of the materials that a recipe names.
//!
//! The fields of the landscape say where each has its place, at the scale of cells. Noise moves the borders by less
//! than that, so that they are ragged as in nature and not smooth as a field.

use super::crags::{Crags, crags};
use super::fractures::Fractures;
use super::rock::BedSpot;
use super::site::Sites;
use super::snow::{SnowSpot, snow_share};
use super::vector::{Vector, add, filter, ramp, scale};
use super::woods::{Canopy, canopy};
use crate::colour::{Linear, linear_of_hex, mix};
use weald_core::grain::{Grain, Octaves};

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
    /// Height above the water beside it in metres, without exaggeration.
    pub(super) above: f32,
    /// Height above it up to which waves throw sand and stones.
    pub(super) beach: f32,
}

/// What light falls on.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceSample {
    /// Share of light that is sent back.
    pub(super) albedo: Linear,
    /// Slope of what is too small for the grid, eastward and northward.
    pub(super) bump: [f32; 2],
}

impl SurfaceSample {
    /// This sample, with a share of another over it.
    fn mixed(&self, other: &Self, share: f32) -> Self {
        let bump = [0, 1].map(|axis| self.bump[axis] * (1.0 - share) + other.bump[axis] * share);
        Self { albedo: mix(self.albedo, other.albedo, share), bump }
    }
}

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
    /// Borders wander with patches more than with detail, and by half of the range of moisture.
    fn patchy(&self) -> f32 {
        0.6 * self.broad + 0.4 * self.fine.value
    }

    /// By how many beds the edge of one is ragged.
    fn torn(&self) -> f32 {
        0.25 * self.fine.value + 0.9 * self.crags.height
    }

    /// Slopes of the fine detail, and of ridges and gullies.
    pub(super) fn rough(&self, strength: f32, craggy: f32) -> [f32; 2] {
        [0, 1].map(|axis| {
            self.evenness * (strength * self.cell * self.fine.slope[axis] + craggy * self.crags.slope[axis])
        })
    }
}

/// Slope that bumps come near but do not pass: from close by, many octaves would add up to needles. Crowns are rounder.
const STEEPEST: f32 = 0.75;
const STEEPEST_CROWN: f32 = 0.95;

/// Steepness from which rock begins to be bare, and is all that there is.
const ROCK: [f32; 2] = [1.08, 1.22];

/// Light that a strand sends back beside dry gravel: sand is damp.
const STRAND: f32 = 0.66;

/// Thickness of a bed of natural rock over the relief.
pub(super) const THICK: f32 = 0.035;

/// By how much rock is bare sooner on one of its blocks than on another.
const BLOCKY: f32 = 0.16;

/// Slope that bumps of bare rock come near: its faces are sharp.
const STEEPEST_ROCK: f32 = 1.3;

/// Share of a ledge that plants hide, and shares of the relief over which they vanish.
const GREEN: f32 = 0.8;
const GREEN_UP_TO: [f32; 2] = [0.55, 0.9];

/// Steepness from which trees become fewer, and from which there are none.
const CLIFF: [f32; 2] = [0.9, 1.3];

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

/// How many times smaller than trees bushes and boulders are, how densely they lie at most, and their share of the light that
/// the ground sends back.
const SMALLER: f32 = 1.7;
const SCATTERED: f32 = 0.3;
const BUSH: Linear = [0.52, 0.6, 0.42];

/// Light that needles and leaves send back beside that of a wood.
const NEEDLES: Linear = [0.62, 0.76, 0.95];
const LEAVES: Linear = [1.18, 1.12, 0.86];

/// How far below the tree line leaves take the place of needles, in widths of the belt in which trees become fewer, and the
/// greatest share of trees with leaves.
const LEAVED: [f32; 2] = [0.3, 2.2];
const MOST_LEAVES: f32 = 0.85;

/// How densely lone trees stand before a wood.
const LONE: f32 = 0.05;

/// Height in metres above the water, and at most that share of a cell, from which trees stand.
const SHORE: [f32; 2] = [2.5, 0.028];

/// The share of the slopes of fine detail that is left where a pixel is so many cells wide: each octave is two thirds as high as
/// the one before and half as long, so that the finest would hide the others from close by under scales.
fn evenness(footprint: f32) -> f32 {
    libm::powf((2.0 * footprint).clamp(0.075, 1.0), 0.4)
}

fn no_steeper(bump: [f32; 2], steepest: f32) -> [f32; 2] {
    let square = (bump[0] * bump[0] + bump[1] * bump[1]) / (steepest * steepest);
    bump.map(|slope| slope / (1.0 + square).sqrt())
}

/// Patches of many cells.
fn broad(cell: f32) -> Octaves {
    Octaves { wavelength: 26.0 * cell, count: 5, gain: 0.55, seed: 0x11 }
}

/// Some thirty beds over the relief, folded by about one of their thickness, at a point.
pub(super) fn bed_spot(point: Vector, limits: &Limits, is_material: bool, footprint: f32) -> BedSpot {
    let (thick, fold) = if is_material { (0.03, 0.8) } else { (THICK, 1.4) };
    let fold = fold * broad(limits.cell).at(point, footprint).value;
    BedSpot { point, fold, thickness: thick * limits.relief.max(1e-3), footprint }
}

/// Limits of the kinds of ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Slope from which rock is bare.
    pub(super) rock: f32,
    /// Height above the lowest ground up to which trees grow, in metres.
    pub(super) trees: f32,
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
        let [lush, meadow, dry, alpine] = [0x44_622f, 0x54_6a37, 0x78_7648, 0x62_683f].map(linear_of_hex);
        let forest = [0x28_3520, 0x66_783e].map(linear_of_hex);
        let rock = [0x74_7270, 0x3e_3c3a, 0x88_7d70].map(linear_of_hex);
        let [scree, gravel, snow] = [0x87_7f70, 0xa9_9d86, 0xe4_e8ee].map(linear_of_hex);
        Self { lush, meadow, dry, alpine, forest, rock, scree, gravel, snow }
    }
}

/// The ground's colours.
#[derive(Debug)]
pub(super) struct Cover {
    pub(super) sites: Sites,
    pub(super) limits: Limits,
    pub(super) palette: Palette,
    /// Direction of the sun, away from which crowns throw their shadows.
    sun: Vector,
}

impl Cover {
    pub(super) fn new(sites: Sites, limits: Limits, sun: Vector) -> Self {
        Self { sites, limits, palette: Palette::default(), sun }
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
        let texture = self.texture(spot);
        let skin = match self.sites.material(spot.place) {
            Some(albedo) => self.of_material(spot, albedo, &texture),
            None => self.natural(spot, &texture),
        };
        // No ground in nature is darker or lighter: wet peat, fresh snow.
        SurfaceSample { albedo: skin.albedo.map(|c| c.clamp(0.01, 0.9)), bump: skin.bump }
    }

    /// How densely trees stand at a point of natural ground, from 0 to 1, and the share of conifers among them.
    pub(super) fn wood(&self, spot: &SurfacePoint) -> [f32; 2] {
        let texture = self.texture(spot);
        let trees = self.trees(spot, self.sites.moisture(spot.place), texture.patchy());
        let bare = ramp(self.slope_of_cells(spot, &texture), CLIFF[0], CLIFF[1]);
        let [sand, washed] = Self::beach(spot, &texture);
        let density =
            trees * (1.0 - bare) * (1.0 - self.snow(spot, &texture)) * (1.0 - sand) * (1.0 - washed);
        [density, self.share_of_conifers(spot.point[2])]
    }

    /// The share of conifers at a height.
    fn share_of_conifers(&self, height: f32) -> f32 {
        1.0 - MOST_LEAVES * ramp(self.below_tree_line(height), LEAVED[0], LEAVED[1])
    }

    fn texture(&self, spot: &SurfacePoint) -> Texture {
        let cell = self.limits.cell;
        // Lengths are in cells, shares and limits in those of the landscape, so that a finer grid looks finer
        // and not other. All numbers here and below are chosen by eye. Patches of many cells, and detail down
        // to a fiftieth of a cell.
        let fine = Octaves { wavelength: 2.4 * cell, count: 8, gain: 0.6, seed: 0x12 };
        Texture {
            broad: broad(cell).at(spot.point, spot.footprint).value,
            fine: fine.at(spot.point, spot.footprint),
            crags: crags(spot.point, spot.fall.map(|towards| -spot.slope * towards), cell, spot.footprint),
            cell,
            evenness: evenness(spot.footprint / cell),
        }
    }

    /// 1 where rock is bare on the average: earlier in patches, and where there is less than usual soil. Trees stand by this,
    /// which is the same from near and from afar.
    fn slope_of_cells(&self, spot: &SurfacePoint, texture: &Texture) -> f32 {
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
        let grass = self.grass(moisture + 0.55 * patchy, high + 0.25 * patchy);
        let grass = scale(grass, 1.0 + 0.3 * fine.value + 0.3 * crags.height);
        let meadow =
            SurfaceSample { albedo: grass, bump: texture.rough(0.12, 0.8 * ramp(spot.slope, 0.1, 0.7)) };
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
        let scree_share = (0.8 * ramp(steep, 0.97, 1.10) * (1.0 - 0.85 * trees)).max(apron);
        let strand = SurfaceSample {
            albedo: scale(self.palette.gravel, STRAND + 0.35 * fine.value),
            bump: texture.rough(0.1, 0.1),
        };
        let stony = meadow.mixed(&scree, scree_share).mixed(&strand, sand);
        // Rock begins where scree is whole; most ground has none.
        let blocks =
            if steep > ROCK[0] - BLOCKY { self.fractures(spot, texture) } else { Fractures::default() };
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
        let white = self.snow(spot, texture);
        let mut open = ground.mixed(&snow, white);
        open.bump = no_steeper(open.bump, STEEPEST + (STEEPEST_ROCK - STEEPEST) * bare * (1.0 - white));
        let cliff = ramp(self.slope_of_cells(spot, texture), CLIFF[0], CLIFF[1]);
        let density = trees * (1.0 - cliff) * (1.0 - white) * (1.0 - sand) * (1.0 - washed);
        let conifers = self.share_of_conifers(spot.point[2]);
        if density > 0.0 { self.under_trees(spot, &open, [density, conifers]) } else { open }
    }

    /// Ground with a wood of such a density and share of conifers on it.
    fn under_trees(
        &self,
        spot: &SurfacePoint,
        open: &SurfaceSample,
        [density, conifers]: [f32; 2],
    ) -> SurfaceSample {
        let [east, north, _] = spot.point;
        let Canopy { share, tone, slope, open: left, chance } =
            canopy([east, north], density, spot.footprint, self.sun);
        let [dark, light] = self.palette.forest;
        let shaded = SurfaceSample { albedo: scale(open.albedo, left), bump: open.bump };
        let kind = mix(LEAVES, NEEDLES, ramp(conifers - chance, -0.08, 0.08));
        let wood = SurfaceSample {
            albedo: filter(kind, mix(dark, light, tone.clamp(0.0, 1.0))),
            bump: no_steeper(slope, STEEPEST_CROWN),
        };
        shaded.mixed(&wood, share)
    }

    fn grass(&self, moisture: f32, high: f32) -> Linear {
        let Palette { lush, meadow, dry, alpine, .. } = self.palette;
        // Moisture is ranked from 0 to 1, so the driest sixth is dry and the wettest lush.
        let low = mix(mix(dry, meadow, ramp(moisture, 0.15, 0.5)), lush, ramp(moisture, 0.5, 0.85));
        mix(low, mix(alpine, dry, ramp(moisture, 0.6, 0.2)), ramp(high, 0.35, 0.8))
    }

    /// How densely trees stand: where it is moist but not boggy, below the tree line, not too steep, and above the shore.
    fn trees(&self, spot: &SurfacePoint, moisture: f32, patchy: f32) -> f32 {
        let line = self.below_tree_line(spot.point[2]);
        let steep = ramp(spot.slope / self.limits.rock, 0.95, 1.3);
        // A score: moisture first, then patches; height below the tree line helps a little and cannot make up
        // for drought.
        let wood = 1.1 * (moisture - 0.5) + 0.9 * patchy + 0.4 * line.clamp(-8.0, 0.8) - 0.4 * steep;
        let [metres, share] = SHORE;
        // Woods thin out at their edges, and a few trees stand far off.
        let density = ramp(wood, 0.02, 0.52).max(LONE * ramp(wood, -0.45, 0.1));
        density * ramp(spot.above, 0.0, metres.min(share * self.limits.cell))
    }

    /// How far below the tree line a height is, in widths of the belt in which trees become fewer.
    pub(super) fn below_tree_line(&self, height: f32) -> f32 {
        (self.limits.trees - height) / (0.12 * self.limits.relief).max(1e-3)
    }

    /// Share of snow.
    fn snow(&self, spot: &SurfacePoint, texture: &Texture) -> f32 {
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
        })
    }

    fn of_material(&self, spot: &SurfacePoint, albedo: Linear, texture: &Texture) -> SurfaceSample {
        // From 27° on a face shows its beds, at 50° whole.
        let steep = ramp(spot.slope, 0.5, 1.2);
        let thick = 0.03 * self.limits.relief.max(1e-3);
        let fold = 0.8 * texture.broad + texture.torn();
        let [bed, thin] = Self::bedding(spot, [thick, thick / 4.1], fold, false);
        let fine = (0.3 - 0.15 * steep) * texture.fine.value + 0.8 * steep * texture.crags.height;
        let bedded = 0.75 * bed.tone + 0.5 * thin.tone - 0.35 * bed.joint - 0.2 * thin.joint;
        let tone = (1.0 + 0.28 * texture.broad + fine + steep * bedded).max(0.2);
        let (rough, ledge) =
            (texture.rough(0.08, 0.14 + 2.14 * steep), steep * (0.3 * bed.ledge + 0.15 * thin.ledge));
        let bump = no_steeper([0, 1].map(|axis| rough[axis] - spot.fall[axis] * ledge), STEEPEST);
        let bushes = self.scattered(spot, texture, steep);
        let bush = filter(BUSH, scale(albedo, 0.35 + bushes.tone));
        let albedo = mix(scale(albedo, tone * bushes.open), bush, 0.85 * bushes.share);
        SurfaceSample { albedo, bump }
    }

    /// Bushes and boulders on gentle ground of materials.
    fn scattered(&self, spot: &SurfacePoint, texture: &Texture, steep: f32) -> Canopy {
        let patchy = texture.broad + 0.6 * texture.fine.value;
        let density = SCATTERED * ramp(patchy, -0.35, 0.5) * (1.0 - steep);
        let [x, y, _] = spot.point;
        canopy([SMALLER * x, SMALLER * y], density, SMALLER * spot.footprint, self.sun)
    }

    /// Whether ground of this height may bear trees.
    pub(super) fn has_woods(&self) -> bool {
        // The score of the best place, at the lowest ground.
        let line = self.below_tree_line(0.0);
        !self.sites.shows_materials() && 1.2 + 0.4 * line.clamp(-8.0, 0.8) > 0.02
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
