//! Limbs in the wind, in closed form: the sibling of [`Sway`](crate::ifs::Sway) for plants that are drawn in real time.
//!
//! [`Sway`](crate::ifs::Sway) goes down all digits of a point, and shares the turn of an axis among its digits in a
//! geometric series. As the parts of an axis shrink by the same ratio, the sum of that series up to a digit is the share of
//! the axis that lies below it. So the turn of a place on a limb follows from how far along it lies, and only branches have
//! to be gone down: a vertex knows its limb, a limb its parent, and a point goes
//! `x → M₁(M₂(… Mₙ(x)))`, with `M` the turn about the rest of a joint by `(at joint + along) · (lean · (u × w) + swing · p)`, the
//! vectors being those of [`wind`](crate::ifs::wind).
//!
//! A joint is a place on its parent, at which its limb and its parent turn alike, and it stays where the limb's own turn is
//! about: so joints never part. What differs: all turns are about directions at rest, and a limb bends in one arc. The
//! wind is that of the land ([`wind`](crate::wind)).

use super::{Limb, Limbs};
use crate::ifs::wind::{AT_JOINT, MOTION, cross, dot, rotated, subtract};
use crate::wind::wave;

/// Speed at which half of the greatest lean is reached over that at which half of the swing is: `HALF_LEAN / HALF_SWING` of
/// [`wind`](crate::ifs::wind).
const SOONER: f32 = 2.0;

/// Push of a wind from which plants lean no further.
const MAX_PUSH: f32 = 0.9;

/// The wind as a plant feels it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalWind {
    /// The push in the plant's own axes, and its direction there; that has length 1.
    pub push: f32,
    /// Direction of the push.
    pub wind: [f32; 3],
    /// About what limbs swing: the direction of the push by that of the stem.
    pub across: [f32; 3],
    /// Moment in seconds, and the plant's phase from 0 to 1.
    pub seconds: f32,
    /// The plant's phase, from 0 to 1.
    pub phase: f32,
}

/// The breeze of a push along x and z of the plant, upright.
pub fn wind_on([x, z]: [f32; 2], seconds: f32, phase: f32) -> LocalWind {
    let push = (x * x + z * z).sqrt();
    let longer = 1.0 / push.max(1e-20);
    let wind = [x * longer, 0.0, z * longer];
    LocalWind { push: push.min(MAX_PUSH), wind, across: [-wind[2], 0.0, wind[0]], seconds, phase }
}

impl Limb {
    /// Half of the vector about which, and by which, a place along the limb turns.
    pub(super) fn half_turn(&self, along: f32, breeze: &LocalWind) -> [f32; 3] {
        let order = self.order as usize;
        let ratio = (breeze.push / (1.0 - breeze.push)).sqrt();
        let breezy = SOONER * ratio / (SOONER * ratio + 1.0);
        let lean = MOTION[order].lean as f32 * breeze.push;
        let turns = MOTION[order].frequency as f32 * breeze.seconds + self.phase + breeze.phase;
        let swing = MOTION[order].swing as f32 * breezy * wave(turns);
        let at_joint = if self.parent.is_none() { 0.0 } else { AT_JOINT };
        let half = 0.5 * (at_joint + along);
        let out = cross(self.direction, breeze.wind);
        std::array::from_fn(|i| half * (lean * out[i] + swing * breeze.across[i]))
    }

    /// Where a point goes by the turn of a place along the limb.
    fn turned(&self, along: f32, breeze: &LocalWind, point: [f32; 3]) -> [f32; 3] {
        let half = self.half_turn(along, breeze);
        let scale = 1.0 / (1.0 + dot(half, half)).sqrt();
        let turn = [half[0] * scale, half[1] * scale, half[2] * scale, scale];
        let arm = subtract(point, self.joint);
        let there = rotated(turn, arm);
        // What it moves by is added, so that a point keeps its bits where nothing turns.
        std::array::from_fn(|i| point[i] + (there[i] - arm[i]))
    }
}

impl Limbs {
    /// Where a point goes that is so far along a limb and whose rest is `rest`.
    pub fn bent(&self, breeze: &LocalWind, limb: u32, along: f32, rest: [f32; 3]) -> [f32; 3] {
        let (mut point, mut along, mut next) = (rest, along, Some(limb));
        while let Some(number) = next {
            let limb = &self.limbs[number as usize];
            point = limb.turned(along, breeze, point);
            (along, next) = (limb.along, limb.parent);
        }
        point
    }
}
