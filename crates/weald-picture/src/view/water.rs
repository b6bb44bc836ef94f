//! Water: where lakes and rivers lie, how deep they are, and how they look from any side.
//!
//! A lake's level goes on over its shore, so that the shore runs where the level cuts the smooth ground and not along
//! cells. Rivers are those of [`super::drawn_rivers`]. A surface mirrors by Schlick's approximation of Fresnel's law (1994,
//! doi 10.1111/1467-8659.1330233); what enters comes back from the bed through twice the depth, or from the water itself.

use super::vector::{Vector, add, dot, filter, ramp, scale, unit};
use crate::colour::mix;
use crate::lakes;
use weald_core::grain::Octaves;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;

/// Rings of cells over which a lake's level goes on.
const RINGS: usize = 5;

/// Depth in cells from which a cell beside a lake belongs to it.
pub(super) const SHALLOW: f32 = 0.04;

/// Depth in cells to which the level falls below dry ground.
pub(super) const DRY: f32 = 0.03;

/// Height of the stones and cusps of a shore, and their longest wavelength, in metres: what all have, and what comes with each
/// metre that waves run up.
const STONES: [f32; 2] = [0.07, 0.03];
const STONES_LENGTH: [f32; 2] = [2.0, 1.2];

/// Height of a beach in metres, of a lake and of the sea.
const BEACH: [f32; 2] = [0.1, 3.0];

/// How much more turbid lakes and rivers are than the sea.
const TURBID: f32 = 3.0;

/// Share of light that water mirrors at right angles.
const NORMAL_REFLECTANCE: f32 = 0.02;

/// Light that clear and deep water sends back, and how fast a metre of it swallows the light of the bed.
pub(super) const BODY: Vector = [0.016, 0.052, 0.058];
pub(super) const ABSORPTION: Vector = [0.42, 0.13, 0.11];

/// Colour of what grows on beds.
pub(super) const WEED: Vector = [0.024, 0.047, 0.042];

/// How far waves run up and down a shore in metres: of a lake, and of the sea.
pub(super) const SWASH: [f32; 2] = [0.7, 13.0];

/// Slope of a bed over which no waves break, and from which all do.
const FLATS: [f32; 2] = [0.004, 0.02];

/// Share of light that foam sends back.
pub(super) const FOAM: f32 = 0.78;

/// Share of the light that gravel sends back dry which it sends back wet.
const WET: f32 = 0.45;

/// Mean square of the slopes of ripples too small to be seen.
const ROUGHNESS: f32 = 0.006;

/// Rise over run of what the horizon's rays are thrown to by ripples too small to be seen: half of twice their slopes.
const STEEP_RIPPLES: f32 = 0.12;

/// Share of light that is mirrored at right angles, and roughness, as shaders get them.
pub(super) const OPTICS: [f32; 2] = [NORMAL_REFLECTANCE, ROUGHNESS];

/// Levels of lakes in metres: below the ground where it is dry. `None` without a lake.
pub(super) fn levels(landscape: &Landscape, ground: &Field) -> Option<Field> {
    let domain = &landscape.domain;
    let water = landscape.field("water").ok()?;
    let lakes = lakes::depths([water, ground], domain)?;
    let (size, cell) = (ground.size(), domain.cell as f32);
    let is_wet = |at: usize| {
        let land = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(at));
        land && water.values()[at] >= SHALLOW * cell
    };
    let surface = |at: usize| ground.values()[at] + water.values()[at];
    let mut known: Vec<bool> = lakes.values().iter().map(|&depth| depth >= 1.0).collect();
    let mut wet = known.clone();
    let mut level: Vec<f32> = (0..size.cells()).map(surface).collect();
    let mut front: Vec<usize> = (0..size.cells()).filter(|&at| known[at]).collect();
    for _ in 0..RINGS {
        let next = ring(size, &front, &known);
        let means: Vec<f32> = next.iter().map(|&at| mean_of_known(&level, &known, size, at)).collect();
        for (&at, mean) in next.iter().zip(means) {
            wet[at] = is_wet(at);
            level[at] = if wet[at] { level[at] } else { mean };
            known[at] = true;
        }
        front = next;
    }
    let above_dry_ground = |at: usize| match (known[at], wet[at]) {
        (_, true) => level[at],
        (true, false) => level[at].min(ground.values()[at] - DRY * cell),
        (false, false) => ground.values()[at] - cell,
    };
    Some(Field::from_values(size, (0..size.cells()).map(above_dry_ground).collect()))
}

/// Unknown neighbours of the cells of a front, in rising order.
fn ring(size: Size, front: &[usize], known: &[bool]) -> Vec<usize> {
    let mut ring: Vec<usize> =
        front.iter().flat_map(|&at| size.neighbours(at)).filter(|&at| !known[at]).collect();
    ring.sort_unstable();
    ring.dedup();
    ring
}

fn mean_of_known(level: &[f32], known: &[bool], size: Size, cell: usize) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for other in size.neighbours(cell).filter(|&other| known[other]) {
        sum += level[other];
        count += 1.0;
    }
    sum / count
}

/// Share of water at a point of a lake or the sea of a depth in metres, whose bed rises so by the metre and whose waves run up
/// a width: stones and cusps of sand stand out where it is shallow, so that its edge is as sharp as the pixel and no line.
pub(super) fn shore(point: Vector, depth: f32, slope: f32, [width, footprint]: [f32; 2]) -> f32 {
    let stands = STONES[0] + STONES[1] * width;
    if depth > stands {
        return 1.0;
    }
    let wavelength = STONES_LENGTH[0] + STONES_LENGTH[1] * width;
    let stones = Octaves { wavelength, count: 7, gain: 0.62, seed: 0x67 }.at(point, footprint).value;
    let over = depth - stands * (0.3 + stones).clamp(0.0, 0.9);
    (over / (footprint * slope).max(0.004) + 0.5).clamp(0.0, 1.0)
}

/// Height above the water, in metres, up to which waves throw sand and stones at a level.
pub(super) fn beach(level: f32, sea: f32) -> f32 {
    if (level - sea).abs() < 0.5 { BEACH[1] } else { BEACH[0] }
}

/// How turbid water is at a height, beside the sea.
pub(super) fn turbidity(level: f32, sea: f32) -> f32 {
    if (level - sea).abs() < 0.5 { 1.0 } else { TURBID }
}

/// The normal of rippled water at a point, for a pixel of that footprint; waves are `length` metres long.
pub(super) fn ripples(point: Vector, length: f32, footprint: f32) -> Vector {
    let calm = Octaves { wavelength: 30.0 * length, count: 2, gain: 0.5, seed: 0x51 }.at(point, 0.0).value;
    let waves = Octaves { wavelength: length, count: 3, gain: 0.55, seed: 0x52 }.at(point, footprint);
    let strength = 0.035 * length * (1.0 + 0.9 * calm);
    unit([-strength * waves.slope[0], -strength * waves.slope[1], 1.0])
}

/// Share of light that is mirrored where a ray meets the surface at an angle of that cosine.
#[inline]
pub(super) fn mirrored_share(cosine: f32) -> f32 {
    let grazing = 1.0 - cosine.clamp(0.0, 1.0);
    let square = grazing * grazing;
    // Seen from low down, the sides of ripples that face the eye mirror less than level water would.
    let fresnel = NORMAL_REFLECTANCE + (1.0 - NORMAL_REFLECTANCE) * square * square * grazing;
    fresnel / (1.0 + 9.0 * ROUGHNESS.sqrt() * square * square)
}

/// The direction of the sky that ripples too small to be seen mirror, in place of that which even water would: from low
/// down only those of their sides are seen that face the eye.
pub(super) fn upward(direction: Vector) -> Vector {
    let [x, y, z] = direction;
    let steeper = 0.5 * z + STEEP_RIPPLES;
    if z < steeper { unit([x, y, steeper]) } else { direction }
}

/// Radiance of the sun in ripples, over the sunlight: Beckmann's distribution of their slopes, as Cox and Munk 1954
/// (doi 10.1364/JOSA.44.000838) measured it at sea.
pub(super) fn glint(towards_eye: Vector, normal: Vector, sun: Vector) -> f32 {
    let half = unit(add(towards_eye, sun));
    let cosine = dot(half, normal).max(0.05);
    let slope2 = (1.0 - cosine * cosine) / (cosine * cosine);
    let facing = cosine * cosine * cosine * cosine;
    let density = libm::expf(-slope2 / ROUGHNESS) / (std::f32::consts::PI * ROUGHNESS * facing);
    density * mirrored_share(dot(half, towards_eye)) / (4.0 * dot(towards_eye, normal).max(0.08))
}

/// Light that comes out of water of a depth over a bed, so much more turbid than the sea, for the light that falls on it.
pub(super) fn body(bed: Vector, depth: f32, turbid: f32, light: Vector) -> Vector {
    let through = ABSORPTION.map(|swallowed| libm::expf(-2.0 * swallowed * turbid * depth));
    let shallow = filter(scale(bed, 0.7), through);
    let deep = filter(scale(BODY, 1.5 / (0.5 + turbid)), through.map(|through| 1.0 - through));
    scale(filter(add(shallow, deep), light), std::f32::consts::FRAC_1_PI)
}

/// The bed below water of a depth, of gravel of a colour: sand, stones, and what grows on it in patches with an edge, most
/// where it is deeper, blurred by the ripples above.
pub(super) fn bed_albedo(gravel: Vector, point: Vector, depth: f32, footprint: f32) -> Vector {
    let blurred = footprint + 0.05 * depth;
    let patches = Octaves { wavelength: 9.0, count: 7, gain: 0.66, seed: 0x5b }.at(point, blurred).value;
    let grains = Octaves { wavelength: 0.55, count: 5, gain: 0.72, seed: 0x5c }.at(point, blurred).value;
    let tone = 1.0 + 0.35 * patches + 0.9 * grains;
    let grown = 0.8 * ramp(patches + 0.3 * grains + 0.1 * depth.min(5.0), 0.22, 0.36);
    mix(scale(gravel, WET * tone.max(0.2)), WEED, grown)
}

/// How far waves run up and down a shore in metres: at a lake, and at the sea.
pub(super) fn swash_width(level: f32, sea: f32) -> f32 {
    if (level - sea).abs() < 0.5 { SWASH[1] } else { SWASH[0] }
}

/// Share of foam on water at so many metres from its edge, where waves run up and down over a width: the line of each
/// moves, and leaves lace behind. Some stretches of a shore lie open and others are sheltered; ponds have next to none.
pub(super) fn swash(point: Vector, away: f32, width: f32, [seconds, footprint]: [f32; 2]) -> f32 {
    let seen = 1.0 - ramp(footprint / width, 0.5, 2.0);
    let along = Octaves { wavelength: 6.0 * width, count: 2, gain: 0.5, seed: 0x5d }.at(point, 0.0).value;
    let lace =
        Octaves { wavelength: 0.2 * width, count: 4, gain: 0.65, seed: 0x5e }.at(point, footprint).value;
    let stretch = Octaves { wavelength: 35.0 * width, count: 2, gain: 0.6, seed: 0x5f }.at(point, 0.0).value;
    let open = ramp(stretch, -0.2, 0.4);
    let strength = (0.25 * width).clamp(0.0, 1.0) * (0.2 + 0.8 * open);
    let turn = seconds / (2.0 * width.sqrt() + 2.0) + 1.5 * along;
    let front = 0.42 + 0.36 * libm::sinf(std::f32::consts::TAU * turn) + 0.12 * lace;
    let behind = front - away / (width * (0.35 + 0.65 * open));
    let line = libm::expf(-90.0 * behind * behind) * (0.6 + 0.9 * lace);
    let left = ramp(behind, 0.0, 0.1) * ramp(lace, 0.05, 0.35);
    seen * strength * (line + 0.6 * left).clamp(0.0, 0.9)
}

/// Share of the waves' foam over a bed of a slope: over flats they have broken far out.
pub(super) fn breaking(slope: f32) -> f32 {
    ramp(slope, FLATS[0], FLATS[1])
}

/// The colour of ground at a water's edge: where waves reach, to a height that is drawn so, wet ground is darker.
pub(super) fn wetted(albedo: Vector, above: f32, reach: f32) -> Vector {
    mix(albedo, scale(albedo, 0.5), 1.0 - ramp(above / reach, 0.25, 1.0))
}

/// Height above the water, drawn, up to which ground of a slope is wet, on cells of a side.
pub(super) fn wet_reach(width: f32, slope: f32, cell: f32) -> f32 {
    (1.3 * width * slope).clamp(0.008 * cell, 0.06 * cell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;

    #[test]
    fn a_lake_is_level_over_its_shore_and_dry_ground_lies_above_it() {
        let size = Size::square(40).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 10.0));
        let ground = Field::from_function(size, |x, y| {
            let away = |c: usize| (c as f32 - 20.0).abs();
            5.0 * away(x).max(away(y))
        });
        let water = Field::from_function(size, |x, y| (40.0 - ground.at(x, y)).max(0.0));
        landscape.insert("water", "m", water);
        let level = levels(&landscape, &ground).expect("there is a lake");
        let wet: Vec<_> = (0..40).filter(|&x| level.at(x, 20) > ground.at(x, 20)).collect();
        assert_eq!((wet[0], wet[wet.len() - 1]), (13, 27));
        assert!(wet.iter().all(|&x| level.at(x, 20) == 40.0));
        assert_eq!(level.at(11, 20), 40.0, "the level goes on over the shore");
    }

    #[test]
    fn grazing_rays_are_mirrored_and_steep_ones_enter() {
        assert!((mirrored_share(1.0) - NORMAL_REFLECTANCE).abs() < 1e-6);
        assert!(mirrored_share(0.05) > 0.4 && mirrored_share(0.5) < 0.06);
    }

    #[test]
    fn a_shore_is_as_sharp_as_the_pixel_and_stones_stand_out_of_shallow_water_alone() {
        let at = |along: u16, depth: f32| shore([f32::from(along) * 0.37, 9.0, 0.0], depth, 0.1, [0.7, 0.02]);
        let wet = |depth: f32| (0..500).filter(|&along| at(along, depth) > 0.5).count();
        assert!(wet(0.0) < wet(0.03) && wet(0.03) < 500 && wet(0.2) == 500, "{} {}", wet(0.0), wet(0.03));
        let between = (0..500).filter(|&along| (0.05..0.95).contains(&at(along, 0.03))).count();
        assert!(between < 120, "{between} of 500 are neither");
    }
}
