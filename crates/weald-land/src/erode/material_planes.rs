//! Where the materials stand among the planes of a state, and the row of the ground that they pile up to.

use pulp::Arch;

use crate::erode::thermal::Ground;
use weald_engine::kernel;
use weald_engine::stencil::ring::Ring;

/// Plane of the change of the bedrock since the start, the first of every state.
const CHANGE: usize = 0;

/// Planes of the regolith: itself, and its outflows to the east, west, south and north.
pub(crate) const REGOLITH_PLANES: usize = 5;

/// The planes of a stack of materials: the change of the bedrock, and the thickness of all others, which stand
/// one after another at the end of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Planes {
    /// Plane of the first material above the bedrock.
    pub(crate) first_layer: usize,
    /// Number of materials, the bedrock included.
    pub(crate) materials: usize,
}

impl Planes {
    /// Number of planes in the state.
    pub(crate) fn count(self) -> usize {
        self.first_layer + self.materials - 1
    }

    /// Plane of a material, bedrock 0.
    pub(crate) fn of(self, material: usize) -> usize {
        if material == 0 { CHANGE } else { self.first_layer + material - 1 }
    }

    /// Copies row `y` of all materials into planes of a state.
    pub(crate) fn copy(self, solid: &[Ring], output: &mut [Ring], y: usize) {
        for (material, ring) in solid.iter().enumerate() {
            output[self.of(material)].here_mut(y).copy_from_slice(ring.here(y));
        }
    }

    /// Copies row `y` of all materials out of planes of a state.
    pub(crate) fn take(self, input: &[Ring], solid: &mut [Ring], y: usize) {
        for (material, ring) in solid.iter_mut().enumerate() {
            ring.here_mut(y).copy_from_slice(input[self.of(material)].here(y));
        }
    }
}

kernel! {
    /// Lays a material on the ground.
    pub(crate) struct Pile {
        reads { thickness }
        updates { ground }
    }
    fn cell() {
        ground += thickness;
    }
}

/// The top of a column: bedrock as start and change, and what lies on it, in the order in which it lies.
pub(crate) fn pile<'a>(
    arch: Arch,
    [base, change]: [&[f32]; 2],
    layers: impl Iterator<Item = &'a [f32]>,
    ground: &mut [f32],
) {
    Ground { base, change, ground: &mut *ground }.run(arch);
    for thickness in layers {
        Pile { thickness, ground: &mut *ground }.run(arch);
    }
}

/// Constant planes of painted weather behind those of the links: share of the rain, share of the evaporation,
/// and what sources give, less what drains take, in cells per step.
pub(crate) const WEATHER_PLANES: usize = 3;
