//! Woods on natural ground: where their trees stand, and their crowns as they look from above.
//!
//! Trees stand on a lattice, each off the middle of its square by chance, as many as their density says. Where crowns are
//! seen one by one each is a dome that is lit by its form, with dark gaps between them and a shadow beside it. From
//! farther away, groups of crowns and stands of groups look the same a few times larger, so that woods have light tops
//! and dark hollows at any distance; each layer fades before its domes become smaller than pixels.

use super::vector::{Vector, ramp};
use weald_core::grain::{Grain, Octaves, bits, floor, visible};

/// Metres from one tree to the next where they stand closest.
pub const SPACING: f32 = 7.0;

/// Layers of domes: crowns, groups of crowns, and so on.
pub(super) const LAYERS: u32 = 4;

/// How many times as far apart the domes of a layer stand as those of the one before.
pub(super) const COARSER: f32 = 2.6;

/// What makes the first layer another than other noise; each further layer has the next.
pub(super) const SEED: u32 = 0x41;

/// Least and greatest radius of a crown, in spacings.
const RADII: [f32; 2] = [0.24, 0.64];

/// Share of the squares with a tree where a wood is densest: through the others one sees down to what grows below.
const FULL: f32 = 0.9;

/// How far a crown may stand off the middle of its square, in spacings; with the greatest radius no more than 1, so that
/// the four nearest squares hold all crowns over a place.
const OFF: f32 = 0.35;

/// Height of the dome of a crown beside its radius, and of a group of them.
const STEEP: [f32; 2] = [0.36, 0.15];

/// Boughs, by which the rims of crowns are ragged: their longest wavelength in metres, how far a rim is moved by their slope,
/// and what they add to the tone and the slope of a crown.
const BOUGHS: f32 = 4.5;
const MOVED: f32 = 1.9;
const LEAFY: [f32; 2] = [0.45, 0.35];

/// Wavelengths in spacings by which crowns and groups of them are told from each other: where a crown is a pixel or two, woods
/// would be speckled.
const TOLD: [f32; 2] = [1.0, 1.35];

/// How much lighter or darker one group of crowns is than another.
const UNLIKE: f32 = 0.3;

/// Tone of what grows below crowns, where one sees down to it.
const BELOW: f32 = 0.3;

/// By how much more than evenly broad crowns are many in a stand of a middle age.
pub(super) const MIDDLE_AGE: f32 = 1.35;

/// Density and age of groups of crowns, of which some are missing, so that their lattice does not show.
pub(super) const GROUPS: [f32; 2] = [0.85, 1.1];

/// Stands, of other kinds and other ages than those beside them: their longest wavelength in metres, and what they add to the
/// tone, to the size of crowns, and to the number by which the kind of a group is chosen.
const STANDS: f32 = 900.0;
const OF_TONE: f32 = 0.8;
const OF_SIZE: f32 = 1.1;
const OF_KIND: f32 = 0.9;

/// Height in spacings from which crowns throw their shadows, and their greatest length.
const SHADE: [f32; 2] = [0.7, 1.1];

/// Height of the tallest tree in metres, beside which others are smaller by chance.
const TALLEST: f32 = 17.0;

/// A tree of a wood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tree {
    /// Where it stands: metres east and north of the north-western corner.
    pub place: [f32; 2],
    /// Its height in metres.
    pub size: f32,
    /// The share of others that stand where woods are thinner: it stands where they are denser than that.
    pub rank: f32,
    /// A number of its own, 0 to 1.
    pub chance: f32,
    /// The angle in radians by which it is turned.
    pub turn: f32,
}

impl Tree {
    /// The tree of a square, whether it stands or not: squares count eastward and northward from the north-western corner.
    pub(super) fn of(square: [i32; 2]) -> Self {
        let (hash, more) = chances(square, SEED);
        Self {
            place: centre(square, hash).map(|along| SPACING * along),
            size: TALLEST * tallness(more),
            rank: part(more, 0),
            chance: part(more, 24),
            turn: std::f32::consts::TAU * part(more, 8),
        }
    }
}

/// What a wood looks like at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Canopy {
    /// Share of the point that crowns and the dark between them cover.
    pub(super) share: f32,
    /// From 0 in gaps to 1 on the tops of crowns.
    pub(super) tone: f32,
    /// Slope of the crowns, eastward and northward.
    pub(super) slope: [f32; 2],
    /// Share of light that shadows of crowns leave to what lies beside them.
    pub(super) open: f32,
    /// The number of its own, 0 to 1, of the tree or the group there, by which its kind is chosen.
    pub(super) chance: f32,
}

/// The uppermost dome over a place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dome {
    /// From 0 at its rim to 1 at the top of the highest.
    pub(super) height: f32,
    /// Rise of the height by one spacing.
    slope: [f32; 2],
    /// A number of its own, 0 to 1.
    chance: f32,
}

/// How much a layer of domes, which are so far apart, is seen of in a pixel of that footprint.
pub(super) fn seen_of_layer(layer: u32, spacing: f32, footprint: f32) -> f32 {
    visible(footprint, TOLD[usize::from(layer > 0)] * spacing)
}

/// A place, or the direction that was eastward, on a lattice that is turned by 37°.
#[inline(always)]
pub(super) fn turned([x, y]: [f32; 2]) -> [f32; 2] {
    [0.8 * x + 0.6 * y, 0.8 * y - 0.6 * x]
}

/// A share from eight bits of a hash.
#[inline(always)]
fn part(hash: u32, shift: u32) -> f32 {
    ((hash >> shift) & 0xff) as f32 * (1.0 / 255.0)
}

/// The uppermost dome at a place that is counted in spacings, where so large a share of them stand.
pub(super) fn dome(place: [f32; 2], seed: u32, [density, age]: [f32; 2]) -> Dome {
    let corner = place.map(|along| floor(along - 0.5));
    let mut top = Dome::default();
    for look in 0..4 {
        let square = [corner[0] + (look & 1), corner[1] + (look >> 1)];
        let (hash, more) = chances(square, seed);
        if part(more, 0) >= density.min(FULL) {
            continue;
        }
        let centre = centre(square, hash);
        let away = [place[0] - centre[0], place[1] - centre[1]];
        let radius = RADII[0] + (RADII[1] - RADII[0]) * (age * part(more, 8)).min(1.0);
        let below = 1.0 - (away[0] * away[0] + away[1] * away[1]) / (radius * radius);
        let tall = tallness(more);
        if below * tall > top.height {
            let steep = -2.0 * tall / (radius * radius);
            top =
                Dome { height: below * tall, slope: away.map(|along| steep * along), chance: part(more, 24) };
        }
    }
    top
}

/// Height of a tree beside that of the tallest.
#[inline(always)]
fn tallness(more: u32) -> f32 {
    0.55 + 0.45 * part(more, 16)
}

/// The random bits of a square: those of its place, and more.
#[inline(always)]
fn chances([x, y]: [i32; 2], seed: u32) -> (u32, u32) {
    let hash = bits(x, y, seed);
    (hash, bits((hash & 0x7fff) as i32, y, seed ^ 0x5bd1))
}

/// Where the tree of a square stands, in spacings.
#[inline(always)]
fn centre([x, y]: [i32; 2], hash: u32) -> [f32; 2] {
    let off = |bits: u32| 2.0 * OFF * ((bits & 0xffff) as f32 * (1.0 / 65_535.0) - 0.5);
    [x as f32 + 0.5 + off(hash), y as f32 + 0.5 + off(hash >> 16)]
}

/// What a wood of a density, from 0 to 1, looks like at a point in metres, for a pixel of that footprint under a sun in
/// such a direction.
pub(super) fn canopy(point: [f32; 2], density: f32, footprint: f32, sun: Vector) -> Canopy {
    let single = seen_of_layer(0, SPACING, footprint);
    let (mut lumps, mut slope, mut finer, mut spacing) = (0.0, [0.0; 2], single, SPACING);
    let stand = stand(point, footprint);
    let mut chance = 0.5 + OF_KIND * stand;
    let (mut place, mut turn) = (point, [1.0_f32, 0.0]);
    for layer in 1..LAYERS {
        spacing *= COARSER;
        // Each lattice is turned against the one before, or all would stand in rows.
        (place, turn) = (turned(place), turned(turn));
        let seen = seen_of_layer(layer, spacing, footprint);
        if seen <= 0.0 {
            continue;
        }
        let group = dome(place.map(|metres| metres / spacing), SEED + layer, GROUPS);
        // The finest that is seen counts most.
        let weight = seen * (1.0 - 0.55 * finer);
        finer = seen;
        lumps += weight * (0.7 * (group.height - 0.45) + UNLIKE * (group.chance - 0.5));
        chance += weight * 0.7 * (group.chance - 0.5);
        let along = [
            turn[0] * group.slope[0] + turn[1] * group.slope[1],
            turn[0] * group.slope[1] - turn[1] * group.slope[0],
        ];
        slope = [0, 1].map(|axis| slope[axis] + weight * STEEP[1] * along[axis]);
    }
    // Edges break up into groups before they do into trees.
    lumps += OF_TONE * stand;
    let density = (density + 2.4 * lumps * density * (1.0 - density)).clamp(0.0, 1.0);
    let floor = 0.9 * ramp(density, 0.25, 0.8);
    let covered = 0.75 * density * (2.0 - density) * 0.9;
    let share = covered + (1.0 - covered) * floor;
    let far = Canopy { share, tone: 0.42 + 0.55 * lumps, slope, open: 1.0 - 0.4 * density, chance };
    if single <= 0.0 {
        return far;
    }
    let near = crowns(point, [density, floor], (stand, footprint), sun);
    let mixed = |near: f32, far: f32| far + single * (near - far);
    Canopy {
        share: mixed(near.share, far.share),
        tone: mixed(near.tone + 0.45 * lumps, far.tone),
        slope: [0, 1].map(|axis| slope[axis] + single * near.slope[axis]),
        open: mixed(near.open, far.open),
        chance: mixed(near.chance, far.chance),
    }
}

/// What a stand is beside others, about from -0.5 to 0.5.
fn stand(point: [f32; 2], footprint: f32) -> f32 {
    let stands = Octaves { wavelength: STANDS, count: 6, gain: 0.6, seed: SEED + LAYERS + 1 };
    stands.at([point[0], point[1], 0.0], footprint).value
}

/// Crowns of a density that are seen one by one, with so much dark between them.
fn crowns(
    point: [f32; 2],
    [density, floor]: [f32; 2],
    (stand, footprint): (f32, f32),
    sun: Vector,
) -> Canopy {
    let boughs = Octaves { wavelength: BOUGHS, count: 3, gain: 0.65, seed: SEED + LAYERS };
    let Grain { value, slope } = boughs.at([point[0], point[1], 0.0], footprint);
    let place = [0, 1].map(|axis| (point[axis] + MOVED * slope[axis]) / SPACING);
    let age = MIDDLE_AGE + OF_SIZE * stand;
    let tree = dome(place, SEED, [density, age]);
    let within = (5.0 * tree.height).min(1.0);
    let run = (sun[0] * sun[0] + sun[1] * sun[1]).sqrt().max(1e-6);
    let length = (SHADE[0] * run / sun[2].max(1e-3)).min(SHADE[1]) / run;
    let shaded = dome([place[0] + length * sun[0], place[1] + length * sun[1]], SEED, [density, age]);
    let dark = (4.0 * shaded.height).min(1.0) * (1.0 - within);
    let tone = 0.35 + 0.36 * tree.height + 0.22 * (tree.chance - 0.5) + LEAFY[0] * value;
    Canopy {
        share: within + (1.0 - within) * floor,
        tone: within * tone + (1.0 - within) * BELOW,
        slope: [0, 1].map(|axis| within * (STEEP[0] * tree.slope[axis] + LEAFY[1] * slope[axis])),
        open: 1.0 - 0.55 * dark,
        chance: tree.chance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUN: Vector = [-0.8, 0.0, 0.6];

    /// Means over a wood of a density, by such a look.
    fn mean(density: f32, footprint: f32, look: impl Fn(Canopy) -> f32) -> f32 {
        let points = (0..20_000_u16).map(|at| {
            let at = f32::from(at);
            canopy([at * 1.37 % 911.0, at * 2.71 % 787.0], density, footprint, SUN)
        });
        points.map(look).sum::<f32>() / 20_000.0
    }

    fn deviation(density: f32, footprint: f32, look: impl Fn(Canopy) -> f32 + Copy) -> f32 {
        let whole = mean(density, footprint, look);
        mean(density, footprint, |canopy| (look(canopy) - whole) * (look(canopy) - whole)).sqrt()
    }

    #[test]
    fn woods_are_as_dense_from_afar_as_from_close_by() {
        for density in [0.0, 0.2, 0.5, 1.0] {
            let [near, far] = [0.2, 12.0].map(|footprint| mean(density, footprint, |canopy| canopy.share));
            assert!((near - far).abs() < 0.08, "at {density}: {near} from close by, {far} from afar");
        }
        let tone = |footprint: f32| {
            mean(1.0, footprint, |canopy| canopy.share * canopy.tone)
                / mean(1.0, footprint, |canopy| canopy.share)
        };
        let [near, far] = [0.2, 12.0].map(tone);
        assert!((near - far).abs() < 0.12, "tones {near} and {far}");
        assert_eq!(mean(0.0, 0.2, |canopy| canopy.share), 0.0, "no wood, no crowns");
        assert!(mean(1.0, 0.2, |canopy| canopy.share) > 0.85);
    }

    #[test]
    fn a_wood_has_light_and_dark_at_every_distance_up_to_one_hundred_kilometres() {
        for footprint in [0.2, 2.0, 6.0, 12.0, 25.0, 50.0] {
            let tone = deviation(0.9, footprint, |canopy| canopy.tone);
            let slope = deviation(0.9, footprint, |canopy| canopy.slope[0]);
            assert!(tone > 0.04, "at {footprint} m a pixel tones differ by {tone}");
            assert!(slope > 0.06, "at {footprint} m a pixel slopes differ by {slope}");
        }
    }

    #[test]
    fn edges_of_woods_break_up_into_trees() {
        let shares = deviation(0.15, 0.2, |canopy| canopy.share);
        assert!(shares > 0.2, "shares differ by {shares}");
        let groups = deviation(0.4, 12.0, |canopy| canopy.share);
        assert!(groups > 0.05, "and from afar by {groups}");
    }

    #[test]
    fn a_lone_tree_throws_its_shadow_away_from_the_sun() {
        let mut shaded = [0; 2];
        for at in 0..40_000_u16 {
            let point = [f32::from(at % 200) * 0.7, f32::from(at / 200) * 0.7];
            let here = canopy(point, 0.1, 0.1, SUN);
            if here.open < 0.6 {
                // The sun stands in the west, so the crown is westward.
                let crown = |east: f32| canopy([point[0] + east, point[1]], 0.1, 0.1, SUN).share > 0.5;
                shaded[0] += usize::from(crown(-1.1 * SPACING) || crown(-0.8 * SPACING));
                shaded[1] += usize::from(crown(1.1 * SPACING) || crown(0.8 * SPACING));
            }
        }
        assert!(shaded[0] > 400 && shaded[0] > 3 * shaded[1], "{shaded:?}");
    }
}
