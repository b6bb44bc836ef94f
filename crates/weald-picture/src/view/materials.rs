//! Ground of the materials that a recipe names: their beds and blocks where it is steep, bushes and boulders where it is gentle.

use super::cover::{Cover, STEEPEST_ROCK};
use super::crown_relief::seen_crown;
use super::ground_kinds::{SurfacePoint, SurfaceSample};
use super::ground_noise::{STEEPEST, STEEPEST_CROWN, Texture, no_steeper};
use super::slope_grain::on_upright;
use super::vector::{filter, ramp, scale};
use super::woods::{Canopy, canopy};
use crate::colour::{Linear, mix};
use weald_core::grain::Octaves;

/// What beds of a face add to its tone, and the thick and the thin joints between them.
const BEDS: f32 = 0.48;
const JOINTS: [f32; 2] = [0.45, 0.25];

/// What blocks of a material and the cracks between them add to its tone, and how much they lean beside those of other rock: in
/// dry country no soil hides edges.
const BLOCKS: [f32; 2] = [0.5, 2.4];
const LEANING: f32 = 1.5;

/// Pixel at which such blocks are looked at over that of the picture: their edges are to be sharp.
const SHARP: f32 = 0.7;

/// By how many of its beds the edge of one is ragged beside those of other rock.
const TORN_BEDS: f32 = 0.4;

/// How fast ground grows darker by what is taken from its tone, which never comes to 0: what lies in the dark is still seen.
const DARKER: f32 = 1.2;

/// Slopes from which a face of a material shows its beds, and shows them whole: 27° and 50°.
const BEDDED: [f32; 2] = [0.5, 1.2];

/// By how many cells times their noise materials reach into each other, on gentle ground and on such faces, where they are beds
/// with edges: those of a landscape fade into each other over a cell or two.
const MINGLED: [f32; 2] = [3.0, 0.3];

/// Cells uphill of such a face where the column still has what the face has lost, and the least softness of the edge of a material,
/// in metres up and down.
const UPHILL: f32 = 1.5;
const SOFT: f32 = 0.15;

/// How ragged the edge of a material is by the grain of a face, in thicknesses of a bed.
const TORN_EDGE: f32 = 0.25;

/// Longest wavelength of the grain of a steep face over the thickness of a bed.
const GRAINED: f32 = 1.8;

/// Spacing of trees over that of bushes and boulders, which stand as much closer and are as much narrower.
const CLOSER: f32 = 1.05;

/// Share of the places for bushes and boulders that are taken where they are densest.
const SCATTERED: f32 = 0.62;

/// Height of trees over that of bushes: shadows are as short as those of trees under a sun that is as much higher.
const LOWER: f32 = 2.3;

/// Slopes from which they become fewer, and from which there are none: 31° and 44°.
const BUSHY: [f32; 2] = [0.6, 0.95];

/// Slopes from which more and more of them are boulders, 17° and 31°, what such slopes and rubble add to the chance that one is, and
/// the chances from which some are, and all.
const LOOSE: [f32; 2] = [0.3, 0.6];
const LOOSER: f32 = 0.3;
const BOULDERS: [f32; 2] = [0.86, 0.92];

/// What patches and fine detail add to the tone of gentle ground, and how rough that is. On walls they would be drawn out downward.
const PATCHES: f32 = 0.48;
const DETAIL: f32 = 0.3;
const ROUGH: f32 = 0.16;

/// Rubble below walls: how much rougher it is by crags than other ground, and the share of bushes that do not grow on it.
const RUBBLE_ROUGH: f32 = 0.8;
const RUBBLE_BARE: f32 = 0.5;

/// How many times as close together stones are as bushes, the share of their places that are taken, on other ground and
/// in rubble, and slopes from which fewer lie, and from which none do.
const STONY: f32 = 2.7;
const STONES: [f32; 2] = [0.06, 0.6];
const STONELESS: [f32; 2] = [0.7, 1.2];

/// Share of light that bushes send back, and boulders beside the material that they lie on.
const BUSH: Linear = [0.066, 0.074, 0.034];
const BOULDER: Linear = [0.9, 0.88, 0.86];

impl Cover {
    /// The place of which the material lies at a point: materials mingle along their borders.
    pub(super) fn mingled(&self, spot: &SurfacePoint, texture: &Texture) -> [f32; 2] {
        let steep = ramp(spot.slope, BEDDED[0], BEDDED[1]);
        let cells = self.sites.fineness * (MINGLED[0] + (MINGLED[1] - MINGLED[0]) * steep);
        [spot.place[0] + cells * texture.fine.value, spot.place[1] + cells * texture.crags.height]
    }

    pub(super) fn of_material(
        &self,
        spot: &SurfacePoint,
        albedo: Linear,
        texture: &Texture,
    ) -> SurfaceSample {
        let steep = ramp(spot.slope, BEDDED[0], BEDDED[1]);
        let thick = 0.03 * self.limits.relief.max(1e-3);
        let fold = 0.3 * texture.broad + TORN_BEDS * texture.torn();
        let [bed, thin] = Self::bedding(spot, [thick, thick / 4.1], fold, false);
        let (blocks, grained) = if steep > 0.0 {
            let sharper = SurfacePoint { footprint: SHARP * spot.footprint, ..*spot };
            (self.fractures(&sharper, texture, false), Self::grain_of_wall(spot, thick))
        } else {
            Default::default()
        };
        let albedo = self.with_face(spot, (albedo, steep), TORN_EDGE * thick * grained);
        let rubble = (1.0 - steep) * self.sites.fallen(spot.place);
        let gentle = (1.0 - steep) * (PATCHES * texture.broad + DETAIL * texture.fine.value);
        let broken = BLOCKS[0] * blocks.tone - BLOCKS[1] * blocks.crack;
        let bedded = BEDS * (bed.tone + thin.tone) - JOINTS[0] * bed.joint - JOINTS[1] * thin.joint;
        let tone = toned(gentle + steep * (bedded + broken));
        let rough = texture.rough((1.0 - steep) * ROUGH, 0.3 + 1.2 * steep + RUBBLE_ROUGH * rubble);
        let ledge = steep * (0.35 * bed.ledge + 0.25 * thin.ledge);
        let facets = steep * LEANING * Self::facets(spot);
        let bump = [0, 1].map(|axis| rough[axis] - spot.fall[axis] * ledge + facets * blocks.facet[axis]);
        let bump = no_steeper(bump, STEEPEST + (STEEPEST_ROCK - STEEPEST) * steep);
        let ground = SurfaceSample { albedo: scale(albedo, tone), bump };
        self.with_bushes(spot, texture, (albedo, rubble, &ground))
    }

    /// Colour of ground of a colour, of which a share is a face that shows the edges of its beds, ragged by so many metres.
    fn with_face(&self, spot: &SurfacePoint, (albedo, steep): (Linear, f32), ragged: f32) -> Linear {
        if steep <= 0.0 || self.strata.materials.is_empty() {
            return albedo;
        }
        let cells = UPHILL * self.sites.fineness;
        let [height, east, south] = spot.bed;
        let there = [spot.place[0] + cells * east, spot.place[1] + cells * south];
        let soft = SOFT.max(0.5 * spot.footprint * spot.slope.min(1.0));
        let height = height + ragged;
        let (face, top) = self.strata.material(there, height, soft);
        // What stands higher than the ground uphill of it is a crest, of which that does not tell.
        mix(albedo, face, steep * (1.0 - ramp(height - top, -soft, soft)))
    }

    /// Noise of a steep face, on the upright planes beside it: on the level plane it would be drawn out downward.
    fn grain_of_wall(spot: &SurfacePoint, thick: f32) -> f32 {
        let octaves = Octaves { wavelength: GRAINED * thick, count: 6, gain: 0.6, seed: 0x17 };
        let [x, y, z] = spot.point;
        let [east, north] = spot.fall.map(|towards| towards * towards);
        let on = |along: f32| on_upright(octaves, [along, z], spot.footprint).value;
        east * on(y) + north * on(x)
    }

    /// Ground of a material, of which a share is rubble, with its bushes and boulders.
    fn with_bushes(
        &self,
        spot: &SurfacePoint,
        texture: &Texture,
        (material, rubble, ground): (Linear, f32, &SurfaceSample),
    ) -> SurfaceSample {
        let bushes = self.scattered(spot, texture, rubble);
        let loose = LOOSER * (ramp(spot.slope, LOOSE[0], LOOSE[1]) + rubble);
        let kind =
            mix(BUSH, filter(BOULDER, material), ramp(bushes.chance + loose, BOULDERS[0], BOULDERS[1]));
        let albedo = scale(kind, 0.35 + bushes.tone);
        let bush = SurfaceSample { albedo, bump: no_steeper(bushes.slope, STEEPEST_CROWN) };
        // It is darker below bushes than below trees, whose crowns begin higher up.
        let open = bushes.open * bushes.open;
        let shaded = SurfaceSample { albedo: scale(ground.albedo, open), bump: ground.bump };
        self.with_stones(spot, (material, rubble), &shaded).mixed(&bush, 0.85 * bushes.share)
    }

    /// Ground with the stones of its rubble.
    fn with_stones(
        &self,
        spot: &SurfacePoint,
        (material, rubble): (Linear, f32),
        ground: &SurfaceSample,
    ) -> SurfaceSample {
        let stones = self.crowns_of(spot, STONY * CLOSER, stony(spot.slope, rubble));
        let albedo = scale(filter(BOULDER, material), 0.55 + 0.9 * stones.tone);
        let stone = SurfaceSample { albedo, bump: no_steeper(stones.slope, STEEPEST_CROWN) };
        let shaded = SurfaceSample { albedo: scale(ground.albedo, stones.open), bump: ground.bump };
        shaded.mixed(&stone, stones.share)
    }

    /// Bushes and boulders on gentle ground of materials.
    fn scattered(&self, spot: &SurfacePoint, texture: &Texture, rubble: f32) -> Canopy {
        let patchy = texture.broad + 0.6 * texture.fine.value;
        let grown = (1.0 - ramp(spot.slope, BUSHY[0], BUSHY[1])) * (1.0 - RUBBLE_BARE * rubble);
        let density = SCATTERED * ramp(patchy, -1.4, 0.8) * grown;
        self.crowns_of(spot, CLOSER, density)
    }

    /// Crowns so many times as close together as those of trees, of a density.
    fn crowns_of(&self, spot: &SurfacePoint, closer: f32, density: f32) -> Canopy {
        let footprint = closer * spot.footprint;
        let point = [closer * spot.point[0], closer * spot.point[1]];
        let sun = [self.sun[0], self.sun[1], LOWER * self.sun[2]];
        canopy(seen_crown(point, [density, footprint], spot.aslant()), density, footprint, sun)
    }
}

/// Share of the places for stones that are taken on such a slope, of which a share is rubble.
fn stony(slope: f32, rubble: f32) -> f32 {
    let lies = 1.0 - ramp(slope, STONELESS[0], STONELESS[1]);
    lies * (STONES[0] + (STONES[1] - STONES[0]) * rubble)
}

/// What colour is multiplied by where so much is added to its tone.
fn toned(more: f32) -> f32 {
    if more < 0.0 { 1.0 / (1.0 - DARKER * more) } else { 1.0 + more }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_in_the_dark_is_still_seen() {
        // Cracks in the joints of dark beds take more than there is.
        let tones: Vec<f32> = (-40..20).map(|step| toned(0.1 * step as f32)).collect();
        let rises = tones.windows(2).map(|pair| pair[1] / pair[0]).fold(f32::MAX, f32::min);
        assert!(tones[0] > 0.1 && rises > 1.015, "{} at the darkest, {rises} from tone to tone", tones[0]);
        assert_eq!(toned(0.0), 1.0);
    }

    #[test]
    fn stones_lie_in_rubble_and_not_on_walls() {
        assert!(stony(0.4, 1.0) > 5.0 * stony(0.4, 0.0) && stony(0.4, 0.0) > 0.0);
        assert_eq!(stony(1.2, 1.0), 0.0);
    }

    #[test]
    fn the_grain_of_a_wall_changes_as_fast_downward_as_along_it() {
        // A wall that falls to the east, with north along it.
        let at = |[along, down]: [f32; 2]| {
            let spot = SurfacePoint {
                place: [0.0; 2],
                point: [0.1 * down, along, -down],
                slope: 10.0,
                fall: [1.0, 0.0],
                footprint: 0.5,
                sight: [1.0, 0.0, 0.3],
                above: 100.0,
                beach: 0.0,
                bed: [0.0; 3],
            };
            Cover::grain_of_wall(&spot, 10.0)
        };
        let change = |step: [f32; 2]| {
            let leaps = (0..4000).map(|number| {
                let place = step.map(|metres| 1.7 * metres * number as f32);
                (at([0, 1].map(|axis| place[axis] + step[axis])) - at(place)).abs()
            });
            leaps.sum::<f32>() / 4000.0
        };
        let [along, down] = [change([1.0, 0.0]), change([0.0, 1.0])];
        assert!(along > 0.02 && (0.8..1.25).contains(&(down / along)), "{down} downward, {along} along");
    }
}
