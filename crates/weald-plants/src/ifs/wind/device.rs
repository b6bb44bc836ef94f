//! The wind on a device: what the shader `sway.wgsl` is given.

use super::sway::{DEPTH, Sway};
use super::{ORDERS, PHASES, Pose};
use crate::ifs::shader::Shader;
use weald_engine::uniform;
use weald_engine::uniform::Uniform;

/// Puts the points `rests` with their `codes` where a [`Pose`] wants them; `rows` are [`Sway::rows`].
pub const SWAY: Shader = Shader {
    name: "sway",
    text: &[include_str!("sway.wgsl")],
    group: 256,
    uniforms: &["plant", "pose", "range"],
    buffers: &[("rows", false), ("rests", false), ("codes", false), ("swayed", true)],
};

uniform! {
    /// A plant as [`SWAY`] is given it.
    pub struct Plant {
        root: [f32; 4],
        /// Shares of the turn along an axis.
        bends: [[f32; 4]; DEPTH / 4],
        /// Digits that turn.
        depth: u32,
        /// Bits of a digit.
        bits: u32,
    }
}

impl Sway {
    /// The plant as a shader is given it.
    pub fn plant(&self) -> Plant {
        let [x, y, z] = self.root;
        Plant {
            root: [x, y, z, 0.0],
            bends: std::array::from_fn(|four| std::array::from_fn(|i| self.bends[4 * four + i])),
            depth: self.depth as u32,
            bits: self.bits as u32,
        }
    }
}

impl Uniform for Pose {
    const NAME: &'static str = "Pose";

    fn fields() -> Vec<(&'static str, &'static str)> {
        const _: () = assert!(ORDERS == 4 && ORDERS * PHASES == 4 * 64, "the types of the fields below");
        let four = "vec4<f32>";
        vec![("wind", four), ("across", four), ("lean", four), ("swing", "array<vec4<f32>, 64>")]
    }

    fn words(&self) -> Vec<u32> {
        self.numbers().into_iter().map(f32::to_bits).collect()
    }
}
