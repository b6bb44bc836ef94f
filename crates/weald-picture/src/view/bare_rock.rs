//! Bare rock of natural ground: its beds, the blocks into which joints break them, and where waves wash it bare.

use super::cover::Cover;
use super::fractures::{Face, Fractures, fractures};
use super::ground_kinds::{SurfacePoint, SurfaceSample};
use super::ground_noise::{THICK, Texture};
use super::rock::{BedSpot, Beds, beds, dip};
use super::vector::{ramp, scale};
use crate::colour::mix;

/// How ragged beds and joints are, by the fine detail and by crags, in the lesser of a cell and the thickness of a bed.
const RAGGED: [f32; 2] = [0.12, 0.3];
const BENT: [f32; 2] = [0.5, 0.8];

/// Share of its blocks that massive rock shows, and values of the broad noise between which rock becomes broken: no face has joints
/// of one pitch all over.
const MASSIVE: f32 = 0.5;
const BROKEN: [f32; 2] = [-0.25, 0.35];

/// Slopes between which beds come to be seen by their tone, and the share that is on gentler ground: there each runs out over many
/// times its thickness, and would lie in swirls.
const OUTCROPS: [f32; 2] = [0.3, 0.9];
const GENTLE: f32 = 0.25;

/// Slope of the facets of blocks on flat ground, and the least upward part of a normal by which it grows on walls.
const FACETS: f32 = 0.55;
const UPRIGHT: f32 = 0.4;

/// Slopes between which waves of the sea leave no sand, but bare rock, and heights of a beach between which those are; how uneven a beach is, by patches and by detail; and what is worn
/// bare of soil above one of rock.
const SANDY: [f32; 2] = [0.1, 0.28];
const OF_THE_SEA: [f32; 2] = [0.3, 1.5];
const UNEVEN: [f32; 2] = [1.6, 1.1];
const WASHED: f32 = 1.8;

impl Cover {
    /// Slope of the facets of blocks on ground of such a slope.
    pub(super) fn facets(spot: &SurfacePoint) -> f32 {
        FACETS * (1.0 + spot.slope * spot.slope).sqrt().min(1.0 / UPRIGHT)
    }

    /// The blocks of rock at a point, in beds that dip or are level.
    pub(super) fn fractures(&self, spot: &SurfacePoint, texture: &Texture, dips: bool) -> Fractures {
        let [x, y, z] = spot.point;
        let thickness = THICK * self.limits.relief.max(1e-3);
        let bend = texture.cell.min(thickness);
        let [fine, craggy] = [texture.fine.value, texture.crags.height];
        let long = 1.0 / (1.0 + spot.slope * spot.slope).sqrt();
        let found = fractures(&Face {
            place: [x + BENT[0] * bend * fine, y + BENT[1] * bend * craggy],
            level: z + if dips { dip([x, y]) + thickness * self.rock_fold(texture) } else { 0.0 },
            normal: [long * spot.slope * spot.fall[0], long * spot.slope * spot.fall[1], long],
            thickness,
            footprint: spot.footprint,
        });
        let broken = MASSIVE + (1.0 - MASSIVE) * ramp(texture.broad, BROKEN[0], BROKEN[1]);
        Fractures {
            tone: broken * found.tone,
            crack: broken * found.crack,
            facet: found.facet.map(|rise| broken * rise),
            ledge: broken * found.ledge,
        }
    }

    /// By how many beds natural rock is folded: broadly, and a little by what is ragged.
    fn rock_fold(&self, texture: &Texture) -> f32 {
        let thickness = THICK * self.limits.relief.max(1e-3);
        let ragged = RAGGED[0] * texture.fine.value + RAGGED[1] * texture.crags.height;
        1.4 * texture.broad + ragged * (texture.cell / thickness).min(1.0)
    }

    /// Rock with its beds and blocks: light and dark, sunk into cracks and joints.
    pub(super) fn rock(&self, spot: &SurfacePoint, texture: &Texture, blocks: &Fractures) -> SurfaceSample {
        // Some thirty beds over the relief, folded by about one of their thickness, and thinner ones within them.
        let thick = THICK * self.limits.relief.max(1e-3);
        let [bed, thin] = Self::bedding(spot, [thick, thick / 5.3], self.rock_fold(texture), true);
        let [grey, dark, warm] = self.palette.rock;
        let seen = GENTLE + (1.0 - GENTLE) * ramp(spot.slope, OUTCROPS[0], OUTCROPS[1]);
        let tones = [seen * bed.tone, seen * thin.tone];
        let warmth = 0.4 + 0.7 * tones[0] + 0.3 * tones[1] + 0.9 * texture.broad + 0.3 * blocks.tone;
        let stone = mix(grey, warm, warmth.clamp(0.0, 1.0));
        let tone = 0.92 + 0.45 * tones[0] + 0.55 * tones[1] + 0.4 * texture.broad + 0.6 * blocks.tone;
        let stone = scale(stone, tone.max(0.3));
        // A quarter of a smooth face is dark.
        let cracks = 0.22 - 0.6 * texture.fine.value - 2.2 * texture.crags.height
            + seen * (0.7 * bed.joint + 0.6 * thin.joint)
            + 1.1 * blocks.crack;
        let ledge = 0.4 * bed.ledge + 0.3 * thin.ledge;
        let rough = texture.rough(0.2, 2.6);
        let facets = Self::facets(spot);
        SurfaceSample {
            albedo: mix(stone, dark, cracks.clamp(0.0, 1.0)),
            bump: [0, 1].map(|axis| rough[axis] - spot.fall[axis] * ledge + facets * blocks.facet[axis]),
        }
    }

    /// Beds of two thicknesses at a point.
    pub(super) fn bedding(spot: &SurfacePoint, thickness: [f32; 2], fold: f32, dips: bool) -> [Beds; 2] {
        let footprint = spot.footprint * spot.slope;
        let of = |at: usize| {
            let spot = BedSpot {
                point: spot.point,
                fold: fold * thickness[0] / thickness[at],
                thickness: thickness[at],
                footprint,
            };
            beds(&spot, dips, 0x21 + at as u32)
        };
        [of(0), of(1)]
    }

    /// Shares of sand, and of rock that is washed bare, at the edge of water.
    pub(super) fn beach(spot: &SurfacePoint, texture: &Texture) -> [f32; 2] {
        let uneven = 1.0 + UNEVEN[0] * texture.broad + UNEVEN[1] * texture.fine.value;
        let up = spot.above / (spot.beach * uneven.max(0.05)).max(1e-3);
        // Some stretches of a shore have sand, and others rock.
        let steep = ramp(spot.slope - 0.6 * texture.broad, SANDY[0], SANDY[1])
            * ramp(spot.beach, OF_THE_SEA[0], OF_THE_SEA[1]);
        [(1.0 - ramp(up, 0.9, 1.1)) * (1.0 - steep), (1.0 - ramp(up / WASHED, 0.8, 1.1)) * steep]
    }
}
