//! Where a pose of the wind puts 64 points at once, in the widest vectors of the machine: what [`Sway::at`] does for
//! each, operation by operation, so with the same bits.

use super::sway::{
    AT_JOINT, Affine, DEPTH, LAG, Motion, Sway, WHOLE, after, at, carried, direction, hashed, turn_of, turned,
};
use super::{ORDERS, PHASES, Pose, Role};
use crate::ifs::lanes::{LANES, Row};
use weald_core::vectors::widest;

/// Maps that a digit can name.
const DIGITS: usize = 256;

/// Numbers of roles.
const STEM: u32 = Role::Stem.number() as u32;
const BRANCH: u32 = Role::Branch.number() as u32;

/// Bends that an index of five bits can name.
const BENDS: usize = DEPTH.next_power_of_two();

/// A plant in a pose, as tables that vectors look up; an index cannot leave them.
#[derive(Clone, Debug)]
pub struct Posed<'a> {
    sway: &'a Sway,
    pose: &'a Pose,
    /// Numbers of the maps, each for all maps.
    maps: Box<[[f32; DIGITS]; 12]>,
    /// Their roles, by number.
    roles: [u32; DIGITS],
    bends: [f32; BENDS],
    swing: [f32; ORDERS * PHASES],
}

/// Where the way down the digits has come, for all lanes.
struct DigitDescent {
    part: [Row; 12],
    turn: [Row; 4],
    shift: [Row; 3],
    order: [u32; LANES],
    along: [u32; LANES],
    hash: [u32; LANES],
    phase: [u32; LANES],
    /// Whether no stem has been met.
    goes_on: [u32; LANES],
}

impl<'a> Posed<'a> {
    /// A plant in a pose.
    pub fn new(sway: &'a Sway, pose: &'a Pose) -> Self {
        let mut maps = Box::new([[0.0; DIGITS]; 12]);
        let mut roles = [0; DIGITS];
        for (digit, (map, role)) in sway.maps.iter().zip(&sway.roles).enumerate() {
            for (number, value) in map.as_flattened().iter().enumerate() {
                maps[number][digit] = *value;
            }
            roles[digit] = u32::from(role.number());
        }
        let mut bends = [0.0; BENDS];
        bends[..DEPTH].copy_from_slice(&sway.bends);
        let swing = std::array::from_fn(|number| pose.swing[number / PHASES][number % PHASES]);
        Self { sway, pose, maps, roles, bends, swing }
    }

    /// Where points go whose rests are `rests` and whose digits, coarsest first, are `digits`.
    pub fn row<'b>(&self, digits: impl Fn(usize) -> &'b [u8; LANES], rests: &[Row; 3]) -> [Row; 3] {
        let mut swayed = [[0.0; LANES]; 3];
        widest(
            #[inline(always)]
            || {
                // Begun here, so that it is known that no table lies within it.
                let mut descent = DigitDescent::begun();
                for place in 0..self.sway.depth {
                    if descent.goes_on == [0; LANES] {
                        break;
                    }
                    self.step(&mut descent, place as u32, digits(place));
                }
                for lane in 0..LANES {
                    let point = carried(descent.motion(lane), rests.map(|axis| axis[lane]));
                    for (axis, x) in swayed.iter_mut().zip(point) {
                        axis[lane] = x;
                    }
                }
            },
        );
        swayed
    }

    /// One digit further: looks up what the digits say, then computes, since vectors do the second alone.
    #[inline(always)]
    fn step(&self, descent: &mut DigitDescent, place: u32, digits: &[u8; LANES]) {
        let mut found = Found::NONE;
        for (role, &digit) in found.role.iter_mut().zip(digits) {
            *role = self.roles[usize::from(digit)];
        }
        for (found, map) in found.map.iter_mut().zip(self.maps.iter()) {
            for (found, &digit) in found.iter_mut().zip(digits) {
                *found = map[usize::from(digit)];
            }
        }
        descent.branch(place, digits, &found.role);
        for lane in 0..LANES {
            let (order, along) = (descent.order[lane], descent.along[lane]);
            let number =
                order * PHASES as u32 + (descent.phase[lane] + PHASES as u32 - along) % PHASES as u32;
            found.swing[lane] = self.swing[number as usize % (ORDERS * PHASES)];
            found.lean[lane] = self.pose.lean[order as usize % ORDERS];
            let bend = self.bends[along.wrapping_sub(1) as usize % BENDS];
            found.share[lane] = if along == 0 { AT_JOINT } else { bend };
        }
        descent.turn(&found, self.pose, self.sway.root);
    }
}

/// What the digits of all lanes say.
struct Found {
    role: [u32; LANES],
    map: [Row; 12],
    swing: Row,
    lean: Row,
    share: Row,
}

impl Found {
    const NONE: Self = Self {
        role: [0; LANES],
        map: [[0.0; LANES]; 12],
        swing: [0.0; LANES],
        lean: [0.0; LANES],
        share: [0.0; LANES],
    };
}

impl DigitDescent {
    fn begun() -> Self {
        Self {
            part: std::array::from_fn(|number| [WHOLE.as_flattened()[number]; LANES]),
            turn: Motion::NONE.turn.map(|x| [x; LANES]),
            shift: Motion::NONE.shift.map(|x| [x; LANES]),
            order: [0; LANES],
            along: [0; LANES],
            hash: [0; LANES],
            phase: [0; LANES],
            goes_on: [1; LANES],
        }
    }

    /// Takes branches and goes on along axes.
    #[inline(always)]
    fn branch(&mut self, place: u32, digits: &[u8; LANES], roles: &[u32; LANES]) {
        for lane in 0..LANES {
            let is_branch = roles[lane] == BRANCH;
            let hash = hashed(self.hash[lane], u32::from(digits[lane]));
            let (order, along, phase) = (self.order[lane], self.along[lane], self.phase[lane]);
            self.hash[lane] = hash;
            self.order[lane] = if is_branch { (order + 1).min(ORDERS as u32 - 1) } else { order };
            self.along[lane] = if is_branch { 0 } else { along + 1 };
            self.phase[lane] = if is_branch { (hash >> 28) + LAG * place } else { phase };
            self.goes_on[lane] = if roles[lane] == STEM { 0 } else { self.goes_on[lane] };
        }
    }

    /// Turns the parts of lanes that go on.
    #[inline(always)]
    fn turn(&mut self, found: &Found, pose: &Pose, root: [f32; 3]) {
        let (wind, across) = (pose.wind, pose.across);
        for lane in 0..LANES {
            let map: Affine = std::array::from_fn(|i| std::array::from_fn(|j| found.map[4 * i + j][lane]));
            let part = after(&self.part(lane), &map);
            let bend = [found.lean[lane], found.swing[lane], found.share[lane]];
            let half = turn_of((wind, across), direction(&part), bend);
            let motion = turned(self.motion(lane), at(&part, root), half);
            self.put(lane, &part, motion, self.goes_on[lane]);
        }
    }

    #[inline(always)]
    fn part(&self, lane: usize) -> Affine {
        std::array::from_fn(|i| std::array::from_fn(|j| self.part[4 * i + j][lane]))
    }

    #[inline(always)]
    fn motion(&self, lane: usize) -> Motion {
        Motion {
            turn: std::array::from_fn(|axis| self.turn[axis][lane]),
            shift: std::array::from_fn(|axis| self.shift[axis][lane]),
        }
    }

    /// Takes the part, and the motion of lanes that go on.
    #[inline(always)]
    fn put(&mut self, lane: usize, part: &Affine, motion: Motion, goes_on: u32) {
        for (numbers, number) in self.part.iter_mut().zip(part.as_flattened()) {
            numbers[lane] = *number;
        }
        for axis in 0..4 {
            let before = self.turn[axis][lane];
            self.turn[axis][lane] = if goes_on == 0 { before } else { motion.turn[axis] };
        }
        for axis in 0..3 {
            let before = self.shift[axis][lane];
            self.shift[axis][lane] = if goes_on == 0 { before } else { motion.shift[axis] };
        }
    }
}
