//! Joints of rock: beds are broken into blocks that stand out of a face or have fallen from it, each with a tone and a facet
//! of its own, from tens of metres down to the pixel.
//!
//! Blocks fill space: a bed is cut by two sets of upright joints, which are the same for a whole landscape, as stress opens
//! them. A face is a slice through them, so that walls show courses of blocks and crests show slabs, drawn out along none.
//! Each layer of blocks lies within those of the one before and fades before its blocks become smaller than pixels.

use super::vector::{Vector, ramp};
use weald_core::grain::{bits, floor, visible};

/// Height of the largest blocks over the thickness of a bed, and of those of a layer over that of the one before.
const LARGEST: f32 = 1.0;
const SMALLER: f32 = 0.434;

/// Layers of blocks.
const LAYERS: u32 = 7;

/// Sides of a block beside its height.
const SIDES: [f32; 2] = [1.5, 2.3];

/// Directions across the two sets of joints, eastward and northward.
const ACROSS: [[f32; 2]; 2] = [[0.92, 0.39], [-0.47, 0.88]];

/// Width of an open joint over the height of a block.
const OPEN: f32 = 0.06;

/// Pixels of the picture that count as one: blocks go before their edges would be torn by single pixels.
const PIXELS: f32 = 1.6;

/// Share of a layer that is left where the next is seen.
const LEFT: f32 = 0.6;

/// Height in a bed from which a block's top is a ledge.
const TOP: f32 = 0.72;

/// By how much blocks side by side differ in width, and in how many of them: what is wide and what is narrow alternates by folds, of
/// which no two sets have the same period; with blocks of one width walls look laid by masons.
const UNEVEN: [[f32; 2]; 2] = [[0.31, 1.4], [0.117, 2.4]];

/// Least sine of the angle between a face and a joint: flatter cuts would be as wide as blocks.
const FLATTEST: f32 = 0.2;

/// Blocks at a point of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Fractures {
    /// Tone of the blocks, about -0.5 to 0.5.
    pub(super) tone: f32,
    /// Share of the darkness of an open joint.
    pub(super) crack: f32,
    /// Rise of the facets beside that of the face, eastward and northward.
    pub(super) facet: [f32; 2],
    /// Share of a ledge on which soil lies.
    pub(super) ledge: f32,
}

/// A point of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Eastward and northward, as far as joints bend, in metres.
    pub(super) place: [f32; 2],
    /// Height in the pile of beds in metres.
    pub(super) level: f32,
    pub(super) normal: Vector,
    /// Thickness of a bed in metres.
    pub(super) thickness: f32,
    pub(super) footprint: f32,
}

/// A share from eight bits of a hash.
#[inline(always)]
fn part(hash: u32, shift: u32) -> f32 {
    ((hash >> shift) & 0xff) as f32 * (1.0 / 255.0)
}

/// Sine of the angle between a face and a plane whose normal has such a cosine with its own.
fn sine(cosine: f32) -> f32 {
    (1.0 - cosine * cosine).max(FLATTEST * FLATTEST).sqrt()
}

/// A way along blocks of one width as one along blocks of all widths, and how fast it goes there.
fn unevenly(along: f32, phase: f32) -> [f32; 2] {
    UNEVEN.iter().fold([along, 1.0], |[at, rate], &[often, wide]| {
        let fold = along * often + phase;
        let within = fold - fold.floor() - 0.5;
        [at + wide * within.abs(), rate + (often * wide).copysign(within)]
    })
}

/// Blocks of one height.
fn blocks(face: &Face, height: f32, seed: u32) -> Fractures {
    let along = |axis: usize| {
        let [east, north] = ACROSS[axis];
        (face.place[0] * east + face.place[1] * north) / (SIDES[axis] * height)
    };
    let [up, up_rate] = unevenly(face.level / height, 0.37 * (seed & 7) as f32);
    let bed = floor(up);
    // Neither do joints go on from bed to bed, nor across the other set.
    let in_bed = bits(bed, 11, seed);
    let [first, first_rate] = unevenly(along(0) + part(in_bed, 0), part(in_bed, 16));
    let row = floor(first);
    let in_row = bits(row, bed, seed ^ 0x5bd1);
    let [second, second_rate] = unevenly(along(1) + part(in_row, 0), part(in_row, 16));
    let column = floor(second);
    let hash = bits(column, row.wrapping_add(bed.wrapping_mul(57)), seed ^ 0x91e1);

    let [nx, ny, nz] = face.normal;
    let sines = [
        first_rate * sine(nx * ACROSS[0][0] + ny * ACROSS[0][1]) / SIDES[0],
        second_rate * sine(nx * ACROSS[1][0] + ny * ACROSS[1][1]) / SIDES[1],
        up_rate * sine(nz),
    ];
    let blur = face.footprint / height;
    let wide = OPEN.max(0.8 * blur);
    let open = |within: f32, axis: usize, deep: f32| {
        let away = within.min(1.0 - within) / sines[axis];
        deep * (1.0 - ramp(away, 0.25 * wide, wide))
    };
    let within = [first - row as f32, second - column as f32, up - bed as f32];
    // Few joints are open and most are closed.
    let deep = [part(in_row, 8), part(hash, 0), part(in_bed, 8)].map(|chance| chance * chance);
    let crack = (0..3).map(|axis| open(within[axis], axis, deep[axis])).fold(0.0, f32::max);
    let [a, b] = [part(hash, 8), part(hash, 16)].map(|chance| 2.0 * chance - 1.0);
    let soft = (0.8 * blur * sines[2]).clamp(0.03, 0.25);
    let lies = if part(hash, 24) < 0.5 { 1.0 } else { 0.0 };
    Fractures {
        tone: part(hash, 16) - 0.5,
        crack: crack * (2.5 * OPEN / blur.max(1e-6)).min(1.0),
        facet: [0, 1].map(|axis| a * ACROSS[0][axis] + b * ACROSS[1][axis]),
        ledge: lies * ramp(within[2], TOP - soft, TOP + soft),
    }
}

/// The blocks at a point of a face.
pub(super) fn fractures(face: &Face) -> Fractures {
    let mut sum = Fractures::default();
    let mut height = LARGEST * face.thickness;
    let pixel = PIXELS * face.footprint;
    let mut seen = visible(pixel, height);
    for layer in 0..LAYERS {
        if seen <= 0.0 {
            break;
        }
        let smaller = SMALLER * height;
        let next = if layer + 1 < LAYERS { visible(pixel, smaller) } else { 0.0 };
        let here = blocks(face, height, 0x2b + layer);
        let weight = seen * (1.0 - (1.0 - LEFT) * next);
        sum.tone += weight * here.tone;
        sum.crack = sum.crack.max(weight * here.crack);
        sum.facet = [0, 1].map(|axis| sum.facet[axis] + weight * here.facet[axis]);
        sum.ledge = sum.ledge.max(weight * here.ledge);
        (height, seen) = (smaller, next);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: Vector = [0.0, -0.98, 0.2];
    const LEVEL: Vector = [0.0, 0.0, 1.0];

    /// Along a face whose normal is such: east, and up a wall or north on flat ground.
    fn along(normal: Vector, [east, on]: [f32; 2], footprint: f32) -> Fractures {
        let [north, up] = if normal == LEVEL { [on, 3.7] } else { [7.0, on] };
        fractures(&Face { place: [east, north], level: up, normal, thickness: 20.0, footprint })
    }

    #[test]
    fn faces_are_made_of_blocks_with_edges() {
        for normal in [WALL, LEVEL] {
            let tones: Vec<f32> = (0..4000)
                .map(|step| along(normal, [0.05 * step as f32, 0.031 * step as f32], 0.8).tone)
                .collect();
            let leaps = tones.windows(2).filter(|pair| (pair[0] - pair[1]).abs() > 0.02).count();
            let even = tones.windows(2).filter(|pair| pair[0] == pair[1]).count();
            assert!(leaps > 20 && even > 3000, "{leaps} edges, {even} of 4000 steps within blocks");
        }
    }

    #[test]
    fn level_joints_are_as_wide_on_gentle_rock_as_on_walls() {
        // Mean length of what is dark down the fall line of a face that rises so steeply.
        let width = |[north, up]: [f32; 2]| {
            let (mut dark, mut runs, mut before) = (0, 0, false);
            for at in 0..40_000_u16 {
                let [line, on] = [f32::from(at / 4000) * 13.7, f32::from(at % 4000) * 0.05];
                let face = Face {
                    place: [line, north * on],
                    level: up * on,
                    normal: [0.0, -up, north],
                    thickness: 20.0,
                    footprint: 0.3,
                };
                let here = fractures(&face).crack > 0.25;
                dark += i32::from(here);
                runs += i32::from(here && !before);
                before = here;
            }
            dark as f32 * 0.05 / runs as f32
        };
        let [wall, gentle] = [[0.2, 0.98], [0.95, 0.312]].map(width);
        assert!(
            wall > 0.1 && (0.8..1.12).contains(&(gentle / wall)),
            "{gentle} m on gentle rock, {wall} m on walls"
        );
    }

    #[test]
    fn blocks_side_by_side_are_of_all_widths() {
        // Where the largest blocks alone are seen, along a bed.
        let tone = |step: u16| along(WALL, [0.5 * f32::from(step), 3.7], 5.0).tone;
        let edges: Vec<u16> = (1..8000).filter(|&step| (tone(step) - tone(step - 1)).abs() > 0.01).collect();
        let widths: Vec<f32> = edges.windows(2).map(|two| 0.5 * f32::from(two[1] - two[0])).collect();
        let like = |width: &f32| widths.iter().filter(|other| (*other / width - 1.0).abs() < 0.04).count();
        let most = widths.iter().map(like).max().expect("some");
        assert!(widths.len() > 50 && 4 * most < widths.len(), "{most} of {} have one width", widths.len());
    }

    #[test]
    fn blocks_are_seen_from_close_by_and_none_from_afar() {
        let deviation = |footprint: f32| {
            let tones = (0..2000).map(|at| along(WALL, [at as f32 * 1.3, at as f32 * 0.7], footprint).tone);
            (tones.map(|tone| tone * tone).sum::<f32>() / 2000.0).sqrt()
        };
        for footprint in [0.02, 0.1, 0.5, 2.0] {
            assert!((0.1..0.6).contains(&deviation(footprint)), "{} at {footprint} m", deviation(footprint));
        }
        assert_eq!(along(WALL, [5.0, 6.0], 20.0), Fractures::default());
    }
}
