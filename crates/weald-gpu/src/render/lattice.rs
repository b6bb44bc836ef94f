//! Which patches of the ground are drawn, and how finely: a quadtree by distance, without cracks.
//!
//! The ground is a quadtree. Level 0 has the finest spacing of vertices; a square of each level is drawn as quarters of
//! [`QUADS`] by [`QUADS`] quads. A level is used up to a distance at which the error of the next one, on the screen,
//! is no longer seen ([`super::spacing`]); before that distance its odd vertices slide onto their even neighbours, so
//! that it becomes the next level before that begins. Filip Strugar 2009, "Continuous distance-dependent level of
//! detail for rendering heightmaps", doi 10.1080/2151237X.2009.10129287. What differs: distances count what is level
//! alone, and one height of the eye for all, so that what is near is known exactly and does not hang on heights.

use super::frustum::{Frustum, Heights};
use super::levels::{MAX_LEVELS, spacing};
use super::spacing::Ranges;

/// Quads along a side of what is drawn at once: a quarter of a square.
pub(crate) const QUADS: u32 = 16;

/// Quads along a side of a square.
const SQUARE: f32 = 2.0 * QUADS as f32;

/// A patch of the ground that is drawn: [`QUADS`] by [`QUADS`] quads.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Patch {
    /// North-western corner, in places of the scene.
    pub(crate) corner: [f32; 2],
    /// Cells between vertices.
    pub(crate) spacing: f32,
    /// Level of detail.
    pub level: f32,
}

/// The ground from which patches are selected.
#[derive(Debug)]
pub(crate) struct Lattice {
    /// Columns and rows of cells.
    pub(crate) cells: [f32; 2],
    /// Metres of a cell.
    pub(crate) metres: [f32; 2],
    /// Levels from the finest to the one whose single square is the whole ground.
    pub(crate) levels: usize,
    /// Further levels, of squares around the middle of which one quarter holds the whole ground; none where it is a block.
    around: usize,
}

/// Further levels of ground that goes on to the horizon: as far as seven of its longer sides.
const AROUND: usize = 4;

/// From where the ground is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Viewpoint {
    /// Place of the eye.
    pub(crate) place: [f32; 2],
    /// Height of the eye above all ground, in metres.
    pub(crate) above: f32,
}

/// Looks through the quadtree.
struct Selection<'a> {
    lattice: &'a Lattice,
    ranges: &'a Ranges,
    from: Viewpoint,
    heights: &'a Heights,
    view: &'a Frustum,
    patches: Vec<(f32, Patch)>,
}

impl Lattice {
    /// The ground of so many cells.
    pub(crate) fn new(cells: [f32; 2], metres: [f32; 2]) -> Self {
        let longer = cells[0].max(cells[1]);
        let mut levels = 1;
        while Self::side(levels - 1) < longer && levels < MAX_LEVELS {
            levels += 1;
        }
        Self { cells, metres, levels, around: 0 }
    }

    /// The same with ground around it.
    #[must_use]
    pub(crate) fn with_horizon(self, has_horizon: bool) -> Self {
        Self { around: if has_horizon { AROUND } else { 0 }, ..self }
    }

    /// Levels of the ground and of what is around it.
    pub(crate) fn all_levels(&self) -> usize {
        self.levels + self.around
    }

    /// North-western corner of the largest square.
    pub(super) fn first_corner(&self) -> [f32; 2] {
        if self.around == 0 {
            return [0.5; 2];
        }
        [0.5 - 0.5 * Self::side(self.all_levels() - 1); 2]
    }

    /// The corners of the quarters of a square, and their side.
    pub(super) fn quarters(corner: [f32; 2], level: usize) -> ([[f32; 2]; 4], f32) {
        let half = 0.5 * Self::side(level);
        let quarters = [[0.0, 0.0], [half, 0.0], [0.0, half], [half, half]];
        (quarters.map(|[x, y]| [corner[0] + x, corner[1] + y]), half)
    }

    /// Whether a square of such a corner has some ground.
    pub(super) fn has_ground(&self, corner: [f32; 2]) -> bool {
        self.around > 0 || (0..2).all(|axis| corner[axis] < self.cells[axis] + 0.5)
    }

    /// Whether a place lies within the border.
    pub(super) fn holds(&self, place: [f32; 2]) -> bool {
        (0..2).all(|axis| (0.5..=self.cells[axis] + 0.5).contains(&place[axis]))
    }

    /// Whether a patch lies in part beyond the border, where ground goes on.
    pub(crate) fn is_beyond(&self, patch: &Patch) -> bool {
        let side = QUADS as f32 * patch.spacing;
        let leaves =
            |axis: usize| patch.corner[axis] < 0.5 || patch.corner[axis] + side > self.cells[axis] + 0.5;
        self.around > 0 && (0..2).any(leaves)
    }

    /// Cells along the side of a square.
    pub(super) fn side(level: usize) -> f32 {
        SQUARE * spacing(level)
    }

    /// Patches in sight of a view, the nearest first.
    pub(crate) fn select(
        &self,
        from: Viewpoint,
        ranges: &Ranges,
        heights: &Heights,
        view: &Frustum,
    ) -> Vec<Patch> {
        let mut selection = Selection { lattice: self, ranges, from, heights, view, patches: Vec::new() };
        selection.square(self.first_corner(), self.all_levels() - 1);
        let mut patches = selection.patches;
        patches.sort_by(|a, b| a.0.total_cmp(&b.0));
        patches.into_iter().map(|(_, patch)| patch).collect()
    }

    /// All patches of one level.
    pub(crate) fn whole(&self, level: usize) -> Vec<Patch> {
        let side = 0.5 * Self::side(level);
        let [columns, rows] = self.cells.map(|cells| (cells / side).ceil() as u32);
        let at = |number: u32| 0.5 + side * number as f32;
        let patch = |corner| Patch { corner, spacing: spacing(level), level: level as f32 };
        (0..rows).flat_map(|y| (0..columns).map(move |x| patch([at(x), at(y)]))).collect()
    }

    /// Least distance of a square from a standpoint.
    fn distance(&self, from: Viewpoint, corner: [f32; 2], side: f32) -> f32 {
        let away = |axis: usize| {
            let beyond = (corner[axis] - from.place[axis]).max(from.place[axis] - corner[axis] - side);
            beyond.max(0.0) * self.metres[axis]
        };
        let [east, south] = [away(0), away(1)];
        (from.above * from.above + east * east + south * south).sqrt()
    }
}

impl Selection<'_> {
    fn is_drawn(&self, corner: [f32; 2], side: f32) -> bool {
        self.lattice.has_ground(corner) && self.view.meets(&self.heights.box_of(corner, side))
    }

    fn square(&mut self, corner: [f32; 2], level: usize) {
        let side = Lattice::side(level);
        if !self.is_drawn(corner, side) {
            return;
        }
        let (quarters, half) = Lattice::quarters(corner, level);
        for quarter in quarters {
            let distance = self.lattice.distance(self.from, quarter, half);
            if level > 0 && distance <= self.ranges.end(level - 1) {
                self.square(quarter, level - 1);
            } else if self.is_drawn(quarter, half) {
                let patch = Patch { corner: quarter, spacing: spacing(level), level: level as f32 };
                self.patches.push((distance, patch));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn everything(cells: [f32; 2], from: Viewpoint) -> (Lattice, Vec<Patch>) {
        let lattice = Lattice::new(cells, [10.0; 2]);
        let ranges = Ranges::new(&[3.0; MAX_LEVELS], 1.0, 10.0);
        let patches = lattice.select(from, &ranges, &Heights::flat(), &Frustum::everything());
        (lattice, patches)
    }

    #[test]
    fn patches_cover_each_place_once() {
        for place in [[0.0, 0.0], [700.0, 300.0], [-900.0, 3000.0]] {
            let (lattice, patches) = everything([1500.0, 900.0], Viewpoint { place, above: 30.0 });
            assert!(patches.iter().any(|patch| patch.level != patches[0].level), "several levels");
            for sample in 0..4000_u32 {
                let x = 0.5 + lattice.cells[0] * ((sample as f32 * 0.754_877_7).fract());
                let y = 0.5 + lattice.cells[1] * ((sample as f32 * 0.569_840_3).fract());
                let covers = |patch: &&Patch| {
                    let side = QUADS as f32 * patch.spacing;
                    let [left, top] = patch.corner;
                    (left..left + side).contains(&x) && (top..top + side).contains(&y)
                };
                assert_eq!(patches.iter().filter(covers).count(), 1, "({x}, {y})");
            }
        }
    }

    #[test]
    fn ground_around_goes_on_for_seven_sides_and_covers_each_place_once() {
        let lattice = Lattice::new([150.0, 90.0], [10.0; 2]).with_horizon(true);
        let ranges = Ranges::new(&[3.0; MAX_LEVELS], 1.0, 10.0);
        let from = Viewpoint { place: [70.0, 40.0], above: 30.0 };
        let patches = lattice.select(from, &ranges, &Heights::flat(), &Frustum::everything());
        let mut beyond = 0;
        for sample in 0..4000_u32 {
            let [x, y] = [(0.754_877_7, 150.0), (0.569_840_3, 90.0)].map(|(step, side)| {
                0.5 + side - 7.0 * 150.0 + (14.0 * 150.0 - side) * (sample as f32 * step).fract()
            });
            let covers = |patch: &&Patch| {
                let side = QUADS as f32 * patch.spacing;
                let [left, top] = patch.corner;
                (left..left + side).contains(&x) && (top..top + side).contains(&y)
            };
            let covering: Vec<_> = patches.iter().filter(covers).collect();
            assert_eq!(covering.len(), 1, "({x}, {y})");
            let is_outside = x < 0.5 || y < 0.5 || x > 150.5 || y > 90.5;
            assert!(!is_outside || lattice.is_beyond(covering[0]), "({x}, {y})");
            beyond += usize::from(is_outside);
        }
        assert!(beyond > 3000);
    }

    #[test]
    fn the_patches_of_one_level_cover_each_place_once() {
        let lattice = Lattice::new([150.0, 90.0], [10.0; 2]);
        for level in 0..lattice.levels {
            let patches = lattice.whole(level);
            let side = QUADS as f32 * spacing(level);
            for sample in 0..400_u32 {
                let x = 0.5 + lattice.cells[0] * (sample as f32 * 0.754_877_7).fract();
                let y = 0.5 + lattice.cells[1] * (sample as f32 * 0.569_840_3).fract();
                let covers = |patch: &&Patch| {
                    let [left, top] = patch.corner;
                    (left..left + side).contains(&x) && (top..top + side).contains(&y)
                };
                assert_eq!(patches.iter().filter(covers).count(), 1, "level {level}, ({x}, {y})");
            }
        }
    }

    #[test]
    fn the_finest_patch_lies_below_the_eye_and_levels_grow_outward() {
        let (_, patches) = everything([4000.0, 4000.0], Viewpoint { place: [1000.0; 2], above: 0.0 });
        assert_eq!(patches[0].level, 0.0);
        assert!(patches.last().expect("some").level > 2.0);
    }
}
