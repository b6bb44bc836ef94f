//! The trees of woods around the camera: where natural ground bears woods, each of their trees is drawn as such.
//!
//! A compute pass looks at each square of the lattice of woods around the camera (`wood.wgsl`, of which
//! `LitScene::tree_in` is the definition) and puts the tree that stands there, or none, at its place. Beyond their reach
//! trees are on the ground alone, as crowns that look alike (`woods.wgsl` of the view).

use std::sync::OnceLock;

use weald::Error;
use weald::grow::ifs::limbs::Limbs;
use weald::grow::ifs::shapes;
use weald::picture::SPACING_OF_TREES;
use wgpu::{BindGroup, CommandEncoder, ComputePassDescriptor};

use super::batch::{Batch, Kind, colours, leaflets, limbs_of};
use super::pipelines::Pipelines;
use crate::gpu::Gpu;

/// Squares of the lattice along a side of what is known, and by how many that moves with the camera at once.
const SIDE: u32 = 320;
const STRIDE: u32 = 8;

/// Workgroup of the pass.
const GROUP: u32 = 256;

/// How far trees are drawn, in metres.
pub(in crate::render) const REACH: f32 = (SIDE / 2 - STRIDE) as f32 * SPACING_OF_TREES;

/// Fractals of trees, and whether they are conifers.
const KINDS: [(&str, bool); 2] = [("spruce", true), ("crown", false)];

/// Their limbs, the same in every scene: finding them takes a third of the time in which a scene comes to a device that has
/// drawn one before.
static LIMBS: [OnceLock<Limbs>; KINDS.len()] = [const { OnceLock::new() }; KINDS.len()];

/// The trees of woods.
#[derive(Debug)]
pub(super) struct Wood {
    pub(super) kinds: Vec<Batch>,
    /// The middle of what is known, and whether the ground has changed since.
    known: Option<[i64; 2]>,
}

impl Wood {
    pub(super) fn new(gpu: &Gpu, pipelines: &Pipelines) -> Result<Self, Error> {
        let kinds = KINDS.iter().zip(&LIMBS).map(|(&(name, is_conifer), limbs)| {
            let find = || limbs_of(&shapes::find(name).expect("a built-in shape").ifs());
            let wood = [REACH, f32::from(is_conifer), SIDE as f32];
            let limbs = limbs.get_or_init(find);
            let kind = Kind { limbs, colours: colours(name), leaflets: leaflets(name), wood };
            Batch::wood(gpu, &kind, (SIDE * SIDE) as usize, &pipelines.groups)
        });
        let kinds = kinds.collect::<Result<_, _>>()?;
        Ok(Self { kinds, known: None })
    }

    /// Has the trees stand anew for the next camera.
    pub(super) fn forget(&mut self) {
        self.known = None;
    }

    /// Encodes that the trees around a point stand, where it is not so already.
    pub(super) fn grow(
        &mut self,
        encoder: &mut CommandEncoder,
        groups: [&BindGroup; 2],
        pipelines: &Pipelines,
        from: [f32; 3],
    ) {
        let stride = f64::from(STRIDE) * f64::from(SPACING_OF_TREES);
        let middle = [from[0], from[1]].map(|at| (f64::from(at) / stride).floor() as i64);
        if self.known == Some(middle) {
            return;
        }
        self.known = Some(middle);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&pipelines.grow);
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for kind in &self.kinds {
            pass.set_bind_group(2, &kind.stand, &[]);
            pass.dispatch_workgroups((SIDE * SIDE).div_ceil(GROUP), 1, 1);
        }
    }
}
