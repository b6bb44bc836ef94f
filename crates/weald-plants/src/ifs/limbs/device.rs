//! Limbs on a device: their functions in WGSL, and what they are given.

use super::limb::{Corner, Limb};
use crate::ifs::shader::Shader;

/// What bends a limb: to be put behind [`wind::FUNCTIONS`](crate::wind::FUNCTIONS).
pub const FUNCTIONS: &str = include_str!("limbs.wgsl");

/// Where points of limbs go, by which the twins are compared: for each of the `rests`, a point and how far along its limb it
/// lies, one of the `winds`: a place east and north, a moment, and the number of the limb. What it writes are points, and
/// the pushes of the wind.
pub const BEND: Shader = Shader {
    name: "bend",
    text: &[
        weald_core::grain::SHADER,
        include_str!("../../wind.wgsl"),
        include_str!("limbs.wgsl"),
        include_str!("bend.wgsl"),
    ],
    group: 64,
    uniforms: &["range"],
    buffers: &[("limbs", false), ("rests", false), ("winds", false), ("swayed", true), ("pushes", true)],
};

/// A number of a parent that is none.
const NO_PARENT: u32 = 0xf_ffff;

impl Limb {
    /// The limb as a device is given it: in the last word its parent in 20 bits, its order in two and its phase in ten.
    pub fn packed(&self) -> [u32; 8] {
        let phase = ((1024.0 * self.phase) as u32).min(1023);
        let tie = self.parent.unwrap_or(NO_PARENT) | self.order << 20 | phase << 22;
        let [a, b, c] = self.joint.map(f32::to_bits);
        let [d, e, f] = self.direction.map(f32::to_bits);
        [a, b, c, self.along.to_bits(), d, e, f, tie]
    }
}

impl Corner {
    /// The vertex as a device is given it: in the last word its tone and how open it is in eight bits each, its levels in
    /// three each, whether it is of a stem, how far up its leaf in five, and in two its edge, of which 1 is the axis.
    pub fn packed(&self) -> [u32; 12] {
        let byte = |share: f32| (255.0 * share.clamp(0.0, 1.0) + 0.5) as u32;
        let look = byte(self.tone)
            | byte(self.open) << 8
            | self.levels[0] << 16
            | self.levels[1] << 19
            | u32::from(self.is_stem) << 22
            | ((31.0 * self.up.clamp(0.0, 1.0) + 0.5) as u32) << 23
            | ((self.side + 1) as u32) << 28;
        let [a, b, c] = self.rest.map(f32::to_bits);
        let [d, e, f] = self.axis.map(f32::to_bits);
        let [g, h, i] = self.normal.map(f32::to_bits);
        [a, b, c, self.along.to_bits(), d, e, f, self.limb, g, h, i, look]
    }
}
