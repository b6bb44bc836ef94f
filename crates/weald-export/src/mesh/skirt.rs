//! Walls that go down from the edges of a mesh, so that it looks solid.

use super::tin::Tin;
use super::vector::{Vector, unit};

/// Four vertices and two triangles for every edge.
#[derive(Debug, Default)]
pub(super) struct Skirt {
    /// Metres east, up and south.
    pub(super) positions: Vec<Vector>,
    /// Level, outward.
    pub(super) normals: Vec<Vector>,
    /// Seen from outside anticlockwise.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Skirt {
    /// Walls from the outline of a mesh down to a height.
    pub(super) fn of(mesh: &Tin, positions: &[Vector], bottom: f64) -> Self {
        let mut skirt = Self::default();
        for edge in mesh.outline() {
            skirt.add(edge.map(|vertex| positions[vertex as usize]), bottom);
        }
        skirt
    }

    /// Adds the wall under an edge, which has the ground to its left.
    fn add(&mut self, [a, b]: [Vector; 2], bottom: f64) {
        let first = self.positions.len() as u32;
        let down = |corner: Vector| [corner[0], bottom, corner[2]];
        self.positions.extend([a, b, down(a), down(b)]);
        let outward = unit([a[2] - b[2], 0.0, b[0] - a[0]]);
        self.normals.extend([outward; 4]);
        self.triangles.extend([[first + 2, first + 3, first + 1], [first + 2, first + 1, first]]);
    }
}
