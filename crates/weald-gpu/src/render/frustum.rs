//! What a camera can see, as planes, and boxes around parts of the ground.

use weald::picture::{Camera, HeightsBeyond, SceneTexture};

/// Least and greatest corner of a box, in metres.
pub(crate) type Box3 = [[f32; 3]; 2];

/// Half spaces: inward normals and offsets.
#[derive(Clone, Debug)]
pub(crate) struct Frustum {
    planes: Vec<[f32; 4]>,
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Frustum {
    /// What a camera sees.
    pub(crate) fn of(camera: &Camera) -> Self {
        let [across, upward] = camera.half;
        let sides = [(camera.right, across), (camera.up, upward)];
        let planes = sides.into_iter().flat_map(|(axis, half)| {
            [1.0, -1.0].map(|sign| std::array::from_fn(|i| half * camera.forward[i] + sign * axis[i]))
        });
        let planes = planes.chain([camera.forward]);
        Self { planes: planes.map(|normal| plane(normal, camera.eye)).collect() }
    }

    /// What lies between two bounds along each of two directions.
    pub(crate) fn between(axes: [[f32; 3]; 2], bounds: [[f32; 2]; 2]) -> Self {
        let planes = axes.into_iter().zip(bounds);
        let planes = planes.flat_map(|([x, y, z], [low, high])| [[x, y, z, -low], [-x, -y, -z, high]]);
        Self { planes: planes.collect() }
    }

    /// All there is.
    #[cfg(test)]
    pub(crate) fn everything() -> Self {
        Self { planes: Vec::new() }
    }

    /// Whether any of a box may be inside.
    pub(crate) fn meets(&self, [low, high]: &Box3) -> bool {
        self.planes.iter().all(|&[x, y, z, offset]| {
            let farthest = [x, y, z].map(|part| part > 0.0);
            let corner = std::array::from_fn(|axis| if farthest[axis] { high[axis] } else { low[axis] });
            dot([x, y, z], corner) + offset >= 0.0
        })
    }
}

fn plane(normal: [f32; 3], through: [f32; 3]) -> [f32; 4] {
    [normal[0], normal[1], normal[2], -dot(normal, through)]
}

/// Least and greatest heights over squares that double in size.
#[derive(Debug)]
pub(crate) struct Heights {
    /// Finest first: columns, and for each square its bounds.
    levels: Vec<(usize, Vec<[f32; 2]>)>,
    metres: [f32; 2],
    base: f32,
    /// Metres by which heights may have risen or sunk.
    slack: f32,
    /// The heights beyond the border, and the cells within.
    beyond: Option<(HeightsBeyond, [f32; 2])>,
}

/// Control points along the side of the smallest square.
const SMALLEST: usize = 4;

/// Squares along the side of a larger one, at most, by which its bounds are found: fewer and larger ones would reach further beyond it.
const ACROSS: usize = 4;

impl Heights {
    /// Of a ground's control points, for cells of so many metres and a base.
    pub(crate) fn new(top: &SceneTexture, metres: [f32; 2], base: f32) -> Self {
        let [columns, rows] = top.size;
        let finest = blocks([columns, rows], SMALLEST, |x, y| {
            let height = top.values[y * columns + x];
            [height, height]
        });
        Self { levels: coarser(finest), metres, base, slack: 0.0, beyond: None }
    }

    /// The same, where ground of such heights goes on beyond so many cells.
    #[must_use]
    pub(crate) fn with_beyond(self, heights: Option<HeightsBeyond>, cells: [f32; 2]) -> Self {
        Self { beyond: heights.map(|heights| (heights, cells)), ..self }
    }

    /// Takes the bounds of all squares of the ground anew, with room for heights to rise and sink by a share of the relief.
    pub(crate) fn renew(&mut self, bounds: Vec<[f32; 2]>, share: f32) {
        let columns = self.levels[0].0;
        if bounds.len() == self.levels[0].1.len() {
            self.levels = coarser((columns, bounds));
            self.slack = 0.0;
            self.slack = share * (self.highest() - self.lowest());
        }
    }

    /// How many of the smallest squares there are.
    pub(crate) fn squares(&self) -> usize {
        self.levels[0].1.len()
    }

    /// Ground without heights.
    #[cfg(test)]
    pub(crate) fn flat() -> Self {
        Self { levels: vec![(1, vec![[0.0; 2]])], metres: [1.0; 2], base: 0.0, slack: 0.0, beyond: None }
    }

    /// The greatest height of all.
    pub(crate) fn highest(&self) -> f32 {
        self.levels.last().map_or(0.0, |(_, bounds)| bounds[0][1]) + self.slack
    }

    /// The greatest height of all and of what goes on beyond the border.
    pub(crate) fn highest_around(&self) -> f32 {
        self.beyond.map_or(self.highest(), |(beyond, _)| beyond.all[1].max(self.highest()))
    }

    /// Metres by which heights may have risen or sunk since they were known.
    pub(crate) fn slack(&self) -> f32 {
        self.slack
    }

    /// Height of what the ground stands on.
    pub(crate) fn base(&self) -> f32 {
        self.base
    }

    /// The least height of all.
    pub(crate) fn lowest(&self) -> f32 {
        self.levels.last().map_or(0.0, |(_, bounds)| bounds[0][0]) - self.slack
    }

    /// Lets heights rise and sink by so many metres more.
    pub(crate) fn widen(&mut self, metres: f32) {
        self.slack += metres;
    }

    /// The least and the greatest height of a square of the ground, from its corner as a place.
    pub(crate) fn bounds(&self, corner: [f32; 2], side: f32) -> [f32; 2] {
        // The four control points of a patch begin at the whole part of a place.
        let first = corner.map(|at| at.max(0.0) as usize / SMALLEST);
        let last = corner.map(|at| ((at + side).max(0.0) as usize + 3) / SMALLEST);
        let span = (last[0] - first[0]).max(last[1] - first[1]);
        let level =
            (0..self.levels.len() - 1).find(|level| span >> level < ACROSS).unwrap_or(self.levels.len() - 1);
        let (columns, bounds) = &self.levels[level];
        let rows = bounds.len() / columns;
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for y in (first[1] >> level).min(rows - 1)..=(last[1] >> level).min(rows - 1) {
            for x in (first[0] >> level).min(columns - 1)..=(last[0] >> level).min(columns - 1) {
                range = union(range, bounds[y * columns + x]);
            }
        }
        if let Some((heights, cells)) = self.beyond {
            let leaves = |axis: usize| corner[axis] < 0.5 || corner[axis] + side > cells[axis] + 0.5;
            let away =
                |axis: usize| (0.5 - corner[axis] - side).max(corner[axis] - cells[axis] - 0.5).max(0.0);
            let [low, high] = heights.all;
            if away(0).hypot(away(1)) >= heights.far_from {
                range = [low, heights.highest_far];
            } else if (0..2).any(leaves) {
                range = union(range, [low, high]);
            }
        }
        [range[0] - self.slack, range[1] + self.slack]
    }

    /// The box around such a square and what is below it.
    pub(crate) fn box_of(&self, corner: [f32; 2], side: f32) -> Box3 {
        let [low, high] = self.bounds(corner, side);
        let west = (corner[0] - 0.5) * self.metres[0];
        let north = (0.5 - corner[1]) * self.metres[1];
        [
            [west, north - side * self.metres[1], self.base.min(low)],
            [west + side * self.metres[0], north, high],
        ]
    }
}

/// Bounds of squares that double in size, from the finest to that of all.
fn coarser(finest: (usize, Vec<[f32; 2]>)) -> Vec<(usize, Vec<[f32; 2]>)> {
    let mut levels = vec![finest];
    while let Some((columns, bounds)) = levels.last().filter(|(_, bounds)| bounds.len() > 1) {
        let size = [*columns, bounds.len() / columns];
        levels.push(blocks(size, 2, |x, y| bounds[y * columns + x]));
    }
    levels
}

fn union(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Bounds over blocks of so many columns and rows.
fn blocks(size: [usize; 2], side: usize, at: impl Fn(usize, usize) -> [f32; 2]) -> (usize, Vec<[f32; 2]>) {
    let columns = size[0].div_ceil(side);
    let mut bounds = vec![[f32::INFINITY, f32::NEG_INFINITY]; columns * size[1].div_ceil(side)];
    for y in 0..size[1] {
        for x in 0..size[0] {
            let block = &mut bounds[y / side * columns + x / side];
            *block = union(*block, at(x, y));
        }
    }
    (columns, bounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::TextureKind;

    #[test]
    fn a_camera_sees_boxes_before_it_and_none_behind_or_beside() {
        let camera = Camera::looking([0.0; 3], [0.0, 1.0, 0.0], [0.5, 0.4]);
        let frustum = Frustum::of(&camera);
        let unit = |x: f32, y: f32, z: f32| [[x, y, z], [x + 1.0, y + 1.0, z + 1.0]];
        assert!(frustum.meets(&unit(-0.5, 10.0, 0.0)) && frustum.meets(&unit(4.5, 10.0, 0.0)));
        assert!(!frustum.meets(&unit(0.0, -3.0, 0.0)));
        assert!(!frustum.meets(&unit(9.0, 10.0, 0.0)) && !frustum.meets(&unit(0.0, 10.0, -9.0)));
    }

    #[test]
    fn a_box_holds_all_heights_of_its_square() {
        let values = (0..40 * 30).map(|cell| ((cell * 37) % 101) as f32).collect::<Vec<_>>();
        let top = SceneTexture {
            name: "top",
            kind: TextureKind::Exact,
            size: [40, 30],
            layers: 1,
            values: values.clone(),
        };
        let heights = Heights::new(&top, [2.0; 2], -5.0);
        assert_eq!((heights.highest(), heights.highest_around()), (100.0, 100.0));
        let beyond = HeightsBeyond { all: [-3.0, 140.0], highest_far: 120.0, far_from: 8.0 };
        let around = Heights::new(&top, [2.0; 2], -5.0).with_beyond(Some(beyond), [37.0, 27.0]);
        assert_eq!(
            (around.highest(), around.highest_around()),
            (100.0, 140.0),
            "beyond the border it is higher"
        );
        for (corner, bounds) in [
            ([38.0, 4.0], [-3.0, 140.0]),
            ([34.5, 4.0], [-3.0, 140.0]),
            ([-12.0, -40.0], [-3.0, 120.0]),
            ([46.0, 4.0], [-3.0, 120.0]),
        ] {
            assert_eq!(around.bounds(corner, 4.0), bounds, "{corner:?}");
        }
        for (corner, side) in [([0.5, 0.5], 4.0), ([8.5, 16.5], 8.0), ([0.5, 0.5], 64.0), ([30.5, 20.5], 2.0)]
        {
            let [low, high] = heights.box_of(corner, side);
            let last = corner.map(|at| (at + side) as usize);
            for y in corner[1] as usize..=last[1].min(26) {
                for x in corner[0] as usize..=last[0].min(36) {
                    for point in [y * 40 + x, (y + 3) * 40 + x + 3] {
                        assert!((low[2]..=high[2]).contains(&values[point]), "{corner:?} {side}");
                    }
                }
            }
        }
    }
}
