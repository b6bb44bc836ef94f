//! Slippage: every material slides off slopes steeper than its own talus (Šťava et al. 2008).
//!
//! Material `k`, whose top stands at `h_k`, gives each lower neighbour `strength · max(0, h_k - h_k,n - T_k)`,
//! all materials and cells from one old surface, scaled so that no cell gives more than it has; bedrock has no
//! end. Stable while `strength` times the number of materials is at most 1/4. With softening, ground that is
//! rougher than its talus allows loses its hold: `T := max(0, T - 10 max(0, |mean of the neighbours - h| - T /
//! 100))`, and an edge has the mean of its two cells.

mod kernels;

use std::sync::Arc;

use crate::erode::material_planes::{Pile, Planes};
use crate::erode::pipeline::{Equations, Pipeline};
use crate::erode::thermal::{Apply, Axis, Ground};
use kernels::{AvailableShare, Slid, SoftAxis, Softened};
use weald_core::material::MAX_MATERIALS;

/// The method.
#[derive(Clone, Debug)]
pub(crate) struct Slippage {
    /// Steepest slope that rests, as a tangent, for each material, bedrock first.
    pub(crate) talus: Vec<f32>,
    /// Share of the excess that slides in a step.
    pub(crate) strength: f32,
    pub(crate) softening: bool,
    pub(crate) pipeline: Arc<Pipeline>,
}

/// Names of the change of the bedrock and of the thickness of the materials on it, before and after.
const SOLID: [(&str, &str); MAX_MATERIALS] = [
    ("bedrock", "bedrock_after"),
    ("layer_1", "layer_1_after"),
    ("layer_2", "layer_2_after"),
    ("layer_3", "layer_3_after"),
    ("layer_4", "layer_4_after"),
    ("layer_5", "layer_5_after"),
    ("layer_6", "layer_6_after"),
    ("layer_7", "layer_7_after"),
];

impl Slippage {
    /// The method for the materials of these planes.
    pub(crate) fn new(planes: Planes, talus: Vec<f32>, strength: f32, softening: bool) -> Self {
        let mut equations = Equations::new(&["base"], &SOLID[..planes.materials], &());
        equations.number("strength", strength);
        for (material, &talus) in talus.iter().enumerate() {
            equations.number("talus", talus);
            let (before, after) = SOLID[material];
            match material {
                0 => equations.kernel_on::<Ground>(&[("change", before)]),
                _ => equations.kernel_on::<Pile>(&[("thickness", before)]),
            };
            if softening {
                equations.kernel_on::<Softened>(&[("softened", "talus")]).kernel::<SoftAxis>();
            } else {
                equations.kernel::<Axis>();
            }
            match material {
                0 => equations.kernel_on::<Apply>(&[("before", before), ("change", after)]),
                _ => equations
                    .kernel_on::<AvailableShare>(&[("thickness", before)])
                    .kernel_on::<Slid>(&[("before", before), ("thickness", after)]),
            };
        }
        let pipeline = equations.finish().placed(|material| planes.of(material));
        Self { talus, strength, softening, pipeline }
    }
}
