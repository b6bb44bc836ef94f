//! Where a pose of the wind puts a point: turns about joints, from the coarsest part to the finest.
//!
//! A rigid motion `x → q x q* + t` is carried down the digits. At each, the joint of the part is where the motion so
//! far puts its rest; the turn about it joins the motion. The shader `sway.wgsl` has the same names and the same order
//! of operations. Turns are Cayley's: the quaternion `(1, r/2) / √(1 + |r/2|²)` turns by `2 atan(|r|/2)` about r, needs no
//! sine and is nothing for r = 0.

use super::{ORDERS, PHASES, Pose, Role};
use crate::ifs::system::Ifs;

/// Deepest digit that turns; what is finer goes with it.
pub(super) const DEPTH: usize = 24;

/// Words of 32 bits of a code that a shader is given, coarsest first.
pub const WORDS: usize = 4;

/// Share of an order's turn that a branch makes at its joint; its axis makes as much again along its length.
pub(in crate::ifs) const AT_JOINT: f32 = 0.7;

/// How much later the next joint of an axis swings, in phases.
pub(super) const LAG: u32 = 3;

/// Factor of the hash that gives branches their phases.
const SPREAD: u32 = 0x9e37_79b1;

/// A plant that can sway: its maps in single precision and what they make of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sway {
    pub(super) maps: Vec<Affine>,
    pub(super) roles: Vec<Role>,
    pub(super) root: [f32; 3],
    /// Share of the turn of an axis for each digit along it.
    pub(super) bends: [f32; DEPTH],
    pub(super) depth: usize,
    pub(super) bits: usize,
}

/// Rows of `A`, each followed by its part of `t`.
pub(super) type Affine = [[f32; 4]; 3];

/// A rigid motion: a unit quaternion (x, y, z, w), then a shift.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) turn: [f32; 4],
    pub(super) shift: [f32; 3],
}

impl Motion {
    /// None.
    pub(super) const NONE: Self = Self { turn: [0.0, 0.0, 0.0, 1.0], shift: [0.0; 3] };
}

/// The map of the whole plant.
pub(super) const WHOLE: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

impl Sway {
    /// A plant at rest.
    pub fn of(ifs: &Ifs) -> Self {
        let maps = ifs.maps().iter().map(|weighted| {
            let map = weighted.map;
            std::array::from_fn(|i| {
                let [a, b, c] = map.linear[i];
                [a, b, c, map.offset[i]].map(|x| x as f32)
            })
        });
        let bits = ifs.digits().bits();
        Self {
            maps: maps.collect(),
            roles: ifs.maps().iter().map(|weighted| weighted.role).collect(),
            root: ifs.root().map(|x| x as f32),
            bends: bends(ifs),
            depth: DEPTH.min(ifs.code_digits()).min(WORDS * 32 / bits),
            bits,
        }
    }

    /// Where a point goes whose rest is `rest` and whose digits, coarsest first, are `digit`.
    #[inline]
    pub fn at(&self, pose: &Pose, rest: [f32; 3], digit: impl Fn(usize) -> u8) -> [f32; 3] {
        let mut motion = Motion::NONE;
        self.descend(pose, digit, |_, after, _| motion = after);
        carried(motion, rest)
    }

    /// The greatest distance between where a joint goes with what it hangs from and where it goes with what hangs there.
    pub fn joint_gap(&self, pose: &Pose, digit: impl Fn(usize) -> u8) -> f32 {
        let mut worst = 0.0_f32;
        self.descend(pose, digit, |before, after, joint| {
            let (held, hangs) = (carried(before, joint), carried(after, joint));
            let apart = subtract(held, hangs);
            worst = worst.max(dot(apart, apart).sqrt());
        });
        worst
    }

    /// Goes down the digits and shows, for each part, the motion before and after it, and its joint at rest.
    #[inline]
    fn descend(
        &self,
        pose: &Pose,
        digit: impl Fn(usize) -> u8,
        mut look: impl FnMut(Motion, Motion, [f32; 3]),
    ) {
        let (mut part, mut motion) = (WHOLE, Motion::NONE);
        let (mut order, mut along, mut hash, mut phase) = (0, 0, 0_u32, 0_u32);
        for place in 0..self.depth {
            let digit = usize::from(digit(place));
            let role = self.roles[digit];
            if role == Role::Stem {
                break;
            }
            part = after(&part, &self.maps[digit]);
            hash = hashed(hash, digit as u32);
            let share = if role == Role::Branch {
                order = (order + 1).min(ORDERS - 1);
                along = 0;
                phase = (hash >> 28) + LAG * place as u32;
                AT_JOINT
            } else {
                along += 1;
                self.bends[along - 1]
            };
            let joint = at(&part, self.root);
            let swing = pose.swing[order][((phase + PHASES as u32 - along as u32) as usize) % PHASES];
            let before = motion;
            let half = turn_of((pose.wind, pose.across), direction(&part), [pose.lean[order], swing, share]);
            motion = turned(motion, joint, half);
            look(before, motion, joint);
        }
    }

    /// Its maps in the order of the shader: three rows a map, the role in the first number of a fourth row.
    pub fn rows(&self) -> Vec<[f32; 4]> {
        let rows = self.maps.iter().zip(&self.roles);
        rows.flat_map(|(map, &of)| [map[0], map[1], map[2], [f32::from(of.number()), 0.0, 0.0, 0.0]])
            .collect()
    }
}

/// A geometric series of sum 1, with the ratio of the plant's trunk.
fn bends(ifs: &Ifs) -> [f32; DEPTH] {
    let trunk = ifs.maps().iter().find(|weighted| weighted.role == Role::Trunk);
    let ratio = trunk.map_or(0.5, |weighted| weighted.map.ratio()).clamp(0.3, 0.9);
    let mut share = 1.0 - ratio;
    std::array::from_fn(|_| {
        let this = share as f32;
        share *= ratio;
        this
    })
}

/// The hash of a branch, one digit further.
#[inline(always)]
pub(super) fn hashed(hash: u32, digit: u32) -> u32 {
    let mixed = (hash ^ (digit + 1)).wrapping_mul(SPREAD);
    mixed ^ (mixed >> 15)
}

/// Half of the vector about which, and by which, a part turns.
#[inline(always)]
pub(super) fn turn_of(
    (wind, across): ([f32; 3], [f32; 3]),
    direction: [f32; 3],
    [lean, swing, share]: [f32; 3],
) -> [f32; 3] {
    let out = cross(direction, wind);
    let half = 0.5 * share;
    std::array::from_fn(|i| half * (lean * out[i] + swing * across[i]))
}

/// The direction of a part's axis: that of the plant, `y`, seen through its map.
#[inline(always)]
pub(super) fn direction(part: &Affine) -> [f32; 3] {
    let axis = [part[0][1], part[1][1], part[2][1]];
    let length = dot(axis, axis).sqrt();
    let shorten = 1.0 / length.max(1e-20);
    axis.map(|x| x * shorten)
}

/// A motion, and then a turn about where it puts a joint.
#[inline(always)]
pub(super) fn turned(motion: Motion, joint: [f32; 3], half: [f32; 3]) -> Motion {
    let joint = carried(motion, joint);
    let scale = 1.0 / (1.0 + dot(half, half)).sqrt();
    let turn = [half[0] * scale, half[1] * scale, half[2] * scale, scale];
    let arm = rotated(turn, subtract(motion.shift, joint));
    Motion { turn: product(turn, motion.turn), shift: std::array::from_fn(|i| joint[i] + arm[i]) }
}

#[inline(always)]
pub(super) fn carried(motion: Motion, point: [f32; 3]) -> [f32; 3] {
    let turned = rotated(motion.turn, point);
    std::array::from_fn(|i| turned[i] + motion.shift[i])
}

#[inline(always)]
pub(in crate::ifs) fn rotated([x, y, z, w]: [f32; 4], v: [f32; 3]) -> [f32; 3] {
    let once = cross([x, y, z], v).map(|c| 2.0 * c);
    let again = cross([x, y, z], once);
    std::array::from_fn(|i| v[i] + w * once[i] + again[i])
}

#[inline(always)]
pub(super) fn product([ax, ay, az, aw]: [f32; 4], [bx, by, bz, bw]: [f32; 4]) -> [f32; 4] {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

#[inline(always)]
pub(super) fn after(outer: &Affine, inner: &Affine) -> Affine {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let sum = outer[i][0] * inner[0][j] + outer[i][1] * inner[1][j] + outer[i][2] * inner[2][j];
            if j == 3 { sum + outer[i][3] } else { sum }
        })
    })
}

#[inline(always)]
pub(super) fn at(map: &Affine, [x, y, z]: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| map[i][0] * x + map[i][1] * y + map[i][2] * z + map[i][3])
}

#[inline(always)]
pub(in crate::ifs) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(in crate::ifs) fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(in crate::ifs) fn subtract(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}
