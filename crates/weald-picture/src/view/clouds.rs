//! Fair-weather clouds: heaps of noise above the land, lit by the sun, and the shadows that they throw.
//!
//! Broad noise says how far a place lies within a heap, less so further up, where heaps are narrower: their bases are flat.
//! Folded noise in space breaks their sides into puffs, where those are near. A ray is looked at where it meets levels one above
//! the other, and at more between them where a side is near, without what is finer than the metres from one to the next: noise
//! says how dense a heap is there, and what lies towards the sun how much light comes to it. Clouds far away pale as the sky
//! does, and from above, where there is less haze, by what haze there is. All numbers are chosen by eye.

mod mirrored;
#[cfg(test)]
mod tests;

use super::haze::Haze;
use super::sky::Sky;
use super::solid_grain::solid_grain;
use super::terrain::Ray;
use super::vector::{Vector, add, dot, ramp, scale, subtract};
use crate::colour::mix;
use weald_core::grain::{Octaves, visible};

/// Metres from one cloud to the next, and of their base above the highest ground.
const APART: f32 = 2200.0;
const ABOVE: f32 = 1300.0;

/// Octaves of the broad noise, and what each is against the one before.
const BROAD: (u32, f32) = (2, 0.55);

/// Metres from one group of clouds to the next, and by how much noise is higher in a group and lower between: clouds are of all
/// sizes, and stand in groups with clear sky around them.
const GROUPS: f32 = 9000.0;
const GROUPED: f32 = 0.6;

/// Thickness of the layer in metres.
const THICK: f32 = 700.0;

/// Levels at which rays are looked at: at least so many, more where that would be farther apart along the ray than so many
/// metres, and at most so many more, fewer where clouds are lost in the haze or such an angle in radians is seen as one.
const SLICES: [f32; 2] = [24.0, 72.0];
const STEP: f32 = 55.0;
const BLURRED: f32 = 0.02;

/// Where noise says that a side may be near, so many more levels are looked at between two; how much below a side that is at least,
/// and for each metre from one level to the next: what lies between two levels far apart would be seen by some rays and missed by
/// those beside them, and heaps low over the horizon end in combs.
const FINER: f32 = 4.0;
const SIDE: [f32; 2] = [0.1, 0.0008];

/// About the most by which noise changes in a metre: so far from where puffs may be levels are passed over.
const STEEPEST: f32 = 0.0019;

/// Share of what lies behind heaps that is no longer looked for.
const UNSEEN: f32 = 0.02;

/// Noise by which the top of a heap is narrower than its broadest part, and by which its base is, up to that share of its height:
/// with an even base heaps would lie on plates.
const NARROWER: f32 = 0.42;
const ROUND: f32 = 0.24;
const BROADEST: f32 = 0.14;

/// Puffs: their longest wavelength in metres, the number of octaves, what each is against the one before, the mean of folded
/// noise, how near to a side puffs are looked for, and between which noise of heaps they stand out.
const PUFFS: f32 = 800.0;
const PUFF_OCTAVES: u32 = 7;
const PUFF_GAIN: f32 = 0.72;
const PUFF_MEAN: f32 = 0.2;
const NEAR: f32 = 0.45;
const HELD: [f32; 2] = [-0.16, 0.1];
const PUFF_SEED: u32 = 0x77;

/// Shares of a heap's height between which it becomes puffed: its base is ragged, but less than its top.
const FLATTER: [f32; 2] = [-0.15, 0.25];

/// What a metre of a heap hides for each unit of noise above that of its side.
const DENSE: f32 = 0.12;

/// Share of the sunlight that comes through from a sun behind.
const GLOW: f32 = 0.05;

/// Least sines of the angle at which rays that come from below and from above go through the layer: flatter ones meet it beyond
/// all that is seen, and none is looked at further than the first of them.
const FLATTEST: [f32; 2] = [0.01, 0.001];

/// Metres towards the sun at which is looked how much of the heap lies there, and how much of the light that takes.
const SUNWARD: [f32; 2] = [70.0, 260.0];
const TAKEN: [f32; 2] = [3.6, 3.2];

/// What all that lies above a base takes of it, the share of the height over which that ends, and how far within a heap it is all
/// of it: little lies above a base near its edge.
const BASE: [f32; 2] = [2.2, 0.4];
const UNDER: f32 = 0.24;

/// Share of the sunlight that a heap's sunny side sends to the eye, and what comes through all of it.
const SUNNY: f32 = 0.3;
const THROUGH: f32 = 0.035;

/// Shares of the sunlight and of the light of the sky on flat ground that a mean direction of clouds sends to the ground, a
/// steradian.
const MEAN: [f32; 2] = [0.11, 0.22];

/// Metres over which clouds are lost in the haze.
const LOST: f32 = 22_000.0;

/// Share of the sunlight that the densest cloud keeps off.
const SHADOW: f32 = 0.78;

/// Metres over which the edges of their shadows are soft.
const SOFT: f32 = 160.0;

/// The light that clouds before something send along a ray, and the share of what is behind them that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CloudLight {
    pub(super) radiance: Vector,
    pub(super) open: f32,
}

impl CloudLight {
    /// No clouds.
    const NONE: Self = Self { radiance: [0.0; 3], open: 1.0 };

    /// The light along the ray, of so much behind them.
    pub(super) fn over(self, behind: Vector) -> Vector {
        add(self.radiance, scale(behind, self.open))
    }
}

/// A layer of clouds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clouds {
    /// Share of the sky that they hide.
    pub(super) share: f32,
    /// Height at which they lie, as it is drawn.
    pub(super) height: f32,
    /// Light of the sky on flat ground.
    pub(super) skylight: Vector,
    /// Factor on heights.
    exaggeration: f32,
}

impl Clouds {
    /// Clouds over ground that is so high, as it is drawn; `None` where they hide nothing.
    pub(super) fn new(share: f64, sky: &Sky, [highest, exaggeration]: [f32; 2]) -> Option<Self> {
        let skylight = subtract(sky.on_flat_ground(), scale(sky.sunlight, sky.sun[2]));
        let height = highest + ABOVE * exaggeration;
        (share > 0.0).then_some(Self { share: share as f32, height, skylight, exaggeration })
    }

    /// The sky as it lights the ground, with the clouds in it.
    pub(super) fn over_ground(&self, sky: &Sky) -> Sky {
        let mean = add(scale(sky.sunlight, MEAN[0]), scale(self.skylight, MEAN[1]));
        sky.behind_clouds(self.share, mean)
    }

    /// How far a place is within a heap without its puffs, as noise above what makes cloud there, at a share of its height.
    fn heap(&self, [x, y]: [f32; 2], share: f32, footprint: f32) -> f32 {
        let (count, gain) = BROAD;
        let noise = Octaves { wavelength: APART, count, gain, seed: 0x71 }.at([x, y, 0.0], footprint);
        let groups =
            Octaves { wavelength: GROUPS, count: 1, gain: 1.0, seed: 0x72 }.at([x, y, 0.0], footprint);
        noise.value + GROUPED * groups.value - (0.44 - 0.95 * self.share + narrower(share))
    }

    /// The same of a point, with its puffs.
    fn within(&self, [x, y, z]: Vector, footprint: f32) -> f32 {
        let up = (z - self.height) / self.exaggeration;
        let share = up / THICK;
        let heap = self.heap([x, y], share.max(0.0), footprint);
        if heap.abs() > NEAR {
            return heap;
        }
        // Bases are flatter, and sides fade where they end.
        let puffs = ramp(share, FLATTER[0], FLATTER[1]) * ramp(heap.abs(), NEAR, 0.5 * NEAR);
        let puff = puff([x, y, up], footprint);
        // Far outside a heap they would be crumbs that float alone.
        let held = if puff > 0.0 { ramp(heap, HELD[0], HELD[1]) } else { 1.0 };
        heap + puffs * held * puff
    }

    /// Metres along a ray from which on it is in the layer, and for how many; `None` where it does not come there.
    fn stretch(&self, ray: &Ray) -> Option<[f32; 2]> {
        let [bottom, top] = [0.0, THICK].map(|up| self.height + up * self.exaggeration - ray.from[2]);
        let rise = ray.direction[2];
        let flattest = if bottom >= 0.0 { FLATTEST[0] } else { FLATTEST[1] };
        let is_inside = bottom < 0.0 && top > 0.0;
        if !is_inside && rise.abs() < flattest {
            return None;
        }
        let rise = if rise < 0.0 { rise.min(-FLATTEST[1]) } else { rise.max(FLATTEST[1]) };
        let [near, far] = if rise < 0.0 { [top, bottom] } else { [bottom, top] };
        let first = (near / rise).max(0.0);
        let length = (far / rise - first).min(THICK * self.exaggeration / FLATTEST[0]);
        (length > 0.0).then_some([first, length])
    }

    /// The light that a point of a heap sends along a direction.
    fn lit(&self, sky: &Sky, at: Vector, direction: Vector, footprint: f32) -> Vector {
        let level = ((at[2] - self.height) / (THICK * self.exaggeration)).clamp(0.0, 1.0);
        let towards = |step: usize| {
            let there = add(at, scale(sky.sun, SUNWARD[step]));
            TAKEN[step] * self.within(there, footprint.max(0.3 * SUNWARD[step])).max(0.0)
        };
        let under = ramp(self.heap([at[0], at[1]], BROADEST, footprint), 0.0, UNDER);
        let below = BASE[0] * under * (1.0 - ramp(level, 0.0, BASE[1]));
        let through = libm::expf(-(towards(0) + towards(1) + below));
        let glow = GLOW * libm::powf(dot(direction, sky.sun).max(0.0), 12.0);
        add(
            scale(sky.sunlight, THROUGH + SUNNY * through + glow),
            scale(self.skylight, (0.45 + 0.5 * level) * std::f32::consts::FRAC_1_PI),
        )
    }

    /// The light of a point of a heap as it arrives at the start of a ray, and how much of it is seen there.
    fn pale(&self, light: Vector, (sky, haze): (&Sky, Haze), ray: &Ray, reach: f32) -> (Vector, f32) {
        let above = ((ray.from[2] - self.height) / (THICK * self.exaggeration)).clamp(0.0, 1.0);
        let veiled = if above > 0.0 { mix(light, haze.veil(light, ray, reach, sky), above) } else { light };
        (veiled, libm::expf((above - 1.0) * reach / LOST))
    }

    /// The clouds along a ray; `blur` is the angle in radians that is seen as one.
    pub(super) fn before(&self, (sky, haze): (&Sky, Haze), ray: &Ray, blur: f32) -> CloudLight {
        let Some([first, length]) = self.stretch(ray) else {
            return CloudLight::NONE;
        };
        let [count, spacing] = levels([first, length], blur);
        let side = SIDE[0].max(SIDE[1] * spacing).min(NEAR);
        let mut clouds = CloudLight::NONE;
        let (mut left, mut slice, mut before, mut finer) = (1.0, 0.0, 0.0, 1.0);
        while slice <= count - 1.0 && left > UNSEEN {
            let (reach, apart) = (first + slice * spacing, spacing / finer);
            let footprint = apart.max(blur * reach);
            let here = self.within(ray.at(reach), footprint);
            if here > -side && finer < FINER {
                // The side is looked for from the level before, in small steps.
                finer = FINER;
                slice = (slice - 1.0 + 1.0 / FINER).max(0.0);
                continue;
            }
            // Of the metres since the level before, those within a heap: were all of them or none, levels would show as lines.
            let [within, middle] = if slice > 0.0 { inside(before, here) } else { [0.0; 2] };
            let hidden = left * (1.0 - libm::expf(-DENSE * apart * within));
            if hidden > UNSEEN / FINER {
                let light = self.lit(sky, ray.at(reach - middle * apart), ray.direction, footprint);
                let (light, seen) = self.pale(light, (sky, haze), ray, reach);
                clouds.radiance = add(clouds.radiance, scale(light, hidden * seen));
                clouds.open -= hidden * seen;
                left -= hidden;
            }
            before = here;
            if here > -side || slice.fract() > 0.0 {
                slice += 1.0 / finer;
            } else {
                // Nothing is met over so many levels, whatever lies between.
                finer = 1.0;
                slice += 1.0 + ((-NEAR - here).max(0.0) / (STEEPEST * spacing)).floor();
            }
        }
        clouds
    }

    /// Share of the sunlight that comes through them to a point.
    pub(super) fn through(&self, sky: &Sky, point: Vector) -> f32 {
        let length = (self.height - point[2]).max(0.0) / sky.sun[2].max(0.05);
        let at = [0, 1].map(|axis| point[axis] + sky.sun[axis] * length);
        1.0 - SHADOW * ramp(self.heap(at, BROADEST, SOFT), 0.0, 0.34)
    }
}

/// How many levels a ray is looked at that is in the layer from so many metres on, for so many, and metres from one to the next, where
/// such an angle is seen as one. It is no whole number, which would show as lines where it changes.
fn levels([first, length]: [f32; 2], blur: f32) -> [f32; 2] {
    let most = SLICES[0] + SLICES[1] * (1.0 - blur / BLURRED).max(0.0) * libm::expf(-first / LOST);
    let count = (length / STEP).clamp(SLICES[0], most);
    [count, length / (count - 1.0)]
}

/// The noise by which heaps are narrower at a share of their height.
fn narrower(share: f32) -> f32 {
    let below = (1.0 - share / BROADEST).max(0.0);
    NARROWER * share * share + ROUND * below * below
}

/// For a value that changes evenly from one level to the next: the mean of what it has above 0, and how far before the second level
/// the middle of that part lies, as a share of their distance.
fn inside(before: f32, here: f32) -> [f32; 2] {
    if before > 0.0 && here > 0.0 {
        return [0.5 * (before + here), 0.5];
    }
    let most = before.max(here).max(0.0);
    let share = most / (before - here).abs().max(1e-6);
    [0.5 * share * most, if here > 0.0 { 0.5 * share } else { 1.0 - 0.5 * share }]
}

/// Puffs at a point, round outward and sharp inward: folded noise about its mean.
fn puff(point: Vector, footprint: f32) -> f32 {
    let (mut sum, mut strength, mut wavelength) = (0.0, 1.0, PUFFS);
    // Each octave is turned by the angle of the 3-4-5 triangle, so that lattices do not align.
    let mut place = point;
    for octave in 0..PUFF_OCTAVES {
        let seen = strength * visible(footprint, wavelength);
        if seen <= 0.0 {
            break;
        }
        let seed = PUFF_SEED.wrapping_add(octave.wrapping_mul(0x9e37_79b9));
        let here = solid_grain(place.map(|metres| metres / wavelength), seed);
        sum += seen * (here.value.abs() - PUFF_MEAN);
        place = [0.8 * place[0] + 0.6 * place[1], 0.8 * place[1] - 0.6 * place[0], place[2]];
        strength *= PUFF_GAIN;
        wavelength *= 0.5;
    }
    sum
}
