//! Limbs and leaves, as they go over to a device.

use super::leaf;

/// Levels of detail, finest first; of the last a plant has a few leaves in all.
pub const LEVELS: usize = 5;

/// A part that turns about its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limb {
    /// Where it hangs on its parent.
    pub joint: [f32; 3],
    /// Unit vector from there to its tip.
    pub direction: [f32; 3],
    /// Number of the limb on which it hangs; `None` for what stands on the ground.
    pub parent: Option<u32>,
    /// How far along its parent, 0 to 1.
    pub along: f32,
    /// Branchings below it, up to 3.
    pub order: u32,
    /// Its phase in the wind, 0 to 1.
    pub phase: f32,
}

/// A vertex of a leaf or stem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Where it is without wind.
    pub rest: [f32; 3],
    /// The point of the leaf's axis beside it, to which it goes as the leaf becomes narrower.
    pub axis: [f32; 3],
    /// Unit normal of the upper side.
    pub normal: [f32; 3],
    /// How far along its limb, 0 to 1.
    pub along: f32,
    /// Number of its limb.
    pub limb: u32,
    /// First and last level that has it.
    pub levels: [u32; 2],
    /// Whether it is of a stem.
    pub is_stem: bool,
    /// How far up its leaf or stem, from the foot at 0 to the tip at 1.
    pub up: f32,
    /// Which edge of its leaf it is on: -1 to the left, 1 to the right, 0 on the axis.
    pub side: i8,
    /// A number of its leaf's own, 0 to 1.
    pub tone: f32,
    /// How open to the light its place in the plant is, 0 to 1.
    pub open: f32,
}

/// A plant one metre high, rooted at the origin: x to its right, y up, z towards the viewer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limbs {
    /// Limbs, none before its parent.
    pub limbs: Vec<Limb>,
    /// Vertices.
    pub corners: Vec<Corner>,
    /// Corners of each triangle, all of one leaf or stem.
    pub triangles: Vec<[u32; 3]>,
}

impl Limbs {
    /// Corners of the triangles that any of some levels has, in order.
    pub fn triangles_of(&self, [first, last]: [u32; 2]) -> Vec<u32> {
        let lives = |triangle: &&[u32; 3]| {
            let levels = self.corners[triangle[0] as usize].levels;
            levels[0] <= last && levels[1] >= first
        };
        self.triangles.iter().filter(lives).flatten().copied().collect()
    }

    /// Area in square metres of the leaves of a level.
    pub fn area(&self, level: u32) -> f32 {
        self.area_where(|corner| corner.levels[0] <= level && level <= corner.levels[1])
    }

    /// Area of the leaves whose corners are as wanted.
    pub(super) fn area_where(&self, wanted: impl Fn(&Corner) -> bool) -> f32 {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| &self.corners[corner as usize]);
        let leaves = self.triangles.iter().map(corners).filter(|[a, ..]| !a.is_stem && wanted(a));
        leaves.map(|corners| leaf::area(corners.map(|corner| corner.rest))).sum()
    }

    /// Distance in metres from the root to the farthest vertex.
    pub fn radius(&self) -> f32 {
        self.corners.iter().map(|corner| leaf::length(corner.rest)).fold(0.0, f32::max)
    }
}
