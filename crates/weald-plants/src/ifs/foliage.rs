//! A plant as triangles: ribbons along its stems, and a card for each of its leaves.
//!
//! Every part of a fractal is an affine image of the whole, so one picture of the whole is the texture of all leaves: a
//! card is the box of the plant under the map of the part. From the whole the walk follows the maps: what goes on along
//! the axis (`Role::Trunk`) until it is small, branches until they are small enough for a card. The image of the stem
//! (`Role::Stem`) under each part on the way is a ribbon.
//!
//! Flat shapes get their depth from their [habit](Habit): fronds that arch around the root, or planes that cross.
//!
//! For the wind, each vertex has three pairs of numbers, as foliage shaders want them (the weights of `SpeedTree`):
//! how far it goes with the whole plant and in which phase; how far it goes with its leaf and in which phase; the number
//! of branchings below it and the stiffness of its part, 1 for the stem and less the smaller the part.

mod habit;
mod texture;
mod walk;

pub use habit::Habit;
pub use texture::{Colours, Texture};

use super::map::Point;
use super::system::Ifs;
pub(super) use habit::Frond;
use texture::Sheet;
pub(super) use walk::Shape;
use walk::{Piece, pieces};
use weald_core::random::{hash2, unit};

/// A plant one metre high, rooted at the origin: x to its right, y up, z towards the viewer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foliage {
    /// Vertices in metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals of the upper side.
    pub normals: Vec<[f32; 3]>,
    /// Places in the texture, from its top left.
    pub textures: Vec<[f32; 2]>,
    /// Bend with the whole plant, 0 at the root to 1 at the tip, and its phase, 0 to 1, one for each frond.
    pub bends: Vec<[f32; 2]>,
    /// Bend with the leaf, 0 at its joint to 1 at its tip, and its phase, 0 to 1.
    pub flutters: Vec<[f32; 2]>,
    /// Branchings between the root and the vertex, and the stiffness of its part, above 0 to 1.
    pub branches: Vec<[f32; 2]>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Foliage {
    /// The plant of a fractal, of this habit.
    pub fn of(ifs: &Ifs, habit: Habit) -> Self {
        let sheet = Sheet::of(ifs);
        let shape = Shape::of(ifs);
        let pieces = pieces(ifs, habit.leaf());
        let mut foliage = Self::default();
        for frond in habit.fronds() {
            for piece in &pieces {
                Builder { foliage: &mut foliage, sheet: &sheet, shape: &shape, frond: &frond, habit }
                    .add(piece);
            }
        }
        foliage.bring_to_one_metre();
        foliage
    }

    /// Brings the highest vertex to a height of 1.
    fn bring_to_one_metre(&mut self) {
        let highest = self.positions.iter().map(|place| place[1]).fold(0.0, f32::max);
        for number in self.positions.as_flattened_mut() {
            *number /= highest;
        }
    }
}

/// What a vertex of a piece is before it is put in its place.
struct Corner {
    /// Where it is in the shape, which is one unit high.
    flat: Point,
    /// Where it is in the texture.
    texture: [f32; 2],
    /// How far it goes with its leaf.
    flutter: f64,
}

struct Builder<'a> {
    foliage: &'a mut Foliage,
    sheet: &'a Sheet,
    shape: &'a Shape,
    frond: &'a Frond,
    habit: Habit,
}

impl Builder<'_> {
    fn add(&mut self, piece: &Piece) {
        if piece.is_leaf { self.leaf(piece) } else { self.stem(piece) }
    }

    /// A card of two squares in a row, so that it can follow an arch.
    fn leaf(&mut self, piece: &Piece) {
        const ROWS: usize = 2;
        for view in 0..self.sheet.views() {
            let mut corners = Vec::with_capacity(2 * (ROWS + 1));
            for row in 0..=ROWS {
                for side in [0.0, 1.0] {
                    let along = row as f64 / ROWS as f64;
                    let (point, texture) = self.sheet.corner(view, [side, along]);
                    let flutter = self.shape.share_above_root(point);
                    corners.push(Corner { flat: self.shape.flat(piece.map.at(point)), texture, flutter });
                }
            }
            self.strip(piece, &corners);
        }
    }

    /// A ribbon, and one across it where the shape is 3D.
    fn stem(&mut self, piece: &Piece) {
        let Some([foot, top]) = self.shape.stem else { return };
        let [foot, top] = [foot, top].map(|end| self.shape.flat(piece.map.at(end)));
        let texture = Sheet::stem();
        let half = self.shape.stem_half_width * piece.size;
        for view in 0..self.sheet.views() {
            let across = across(foot, top, view);
            let mut corners = Vec::with_capacity(4);
            for (end, half) in [(foot, half), (top, half * self.shape.taper)] {
                for side in [-half, half] {
                    let flat = std::array::from_fn(|axis| end[axis] + side * across[axis]);
                    corners.push(Corner { flat, texture, flutter: 0.0 });
                }
            }
            self.strip(piece, &corners);
        }
    }

    /// A strip of squares from pairs of corners.
    fn strip(&mut self, piece: &Piece, corners: &[Corner]) {
        let first = self.foliage.positions.len() as u32;
        let phase = unit(hash2(piece.key, self.frond.number, 0)) as f32;
        for corner in corners {
            let (place, normal) = self.habit.placed(self.frond, corner.flat);
            let bend = corner.flat[1].clamp(0.0, 1.0);
            self.foliage.positions.push(place.map(|number| number as f32));
            self.foliage.normals.push(normal.map(|number| number as f32));
            self.foliage.textures.push(corner.texture);
            self.foliage.bends.push([(bend * bend) as f32, self.frond.phase as f32]);
            self.foliage.flutters.push([corner.flutter as f32, phase]);
            self.foliage.branches.push([piece.level as f32, piece.size.min(1.0) as f32]);
        }
        for pair in 0..corners.len() as u32 / 2 - 1 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|corner| first + 2 * pair + corner);
            self.foliage.triangles.extend([[a, b, c], [c, b, d]]);
        }
    }
}

/// The unit vector across a stem: in the plane of the shape, or out of it.
pub(super) fn across(foot: Point, top: Point, view: usize) -> Point {
    let along: Point = std::array::from_fn(|axis| top[axis] - foot[axis]);
    let across = if view == 0 { [along[1], -along[0], 0.0] } else { [0.0, -along[2], along[1]] };
    let length = across.iter().map(|number| number * number).sum::<f64>().sqrt();
    let straight = if view == 0 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    if length > 0.0 { across.map(|number| number / length) } else { straight }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::shapes;

    fn plant(name: &str) -> (Ifs, Foliage) {
        let shape = shapes::find(name).expect("built in");
        let ifs = shape.ifs();
        let foliage = Foliage::of(&ifs, Habit::of(&ifs, None));
        (ifs, foliage)
    }

    #[test]
    fn every_shape_becomes_a_plant_of_one_metre_with_whole_attributes() {
        for shape in shapes::SHAPES {
            let (_, plant) = plant(shape.name);
            let count = plant.positions.len();
            assert!((8..100_000).contains(&count), "{}: {count} vertices", shape.name);
            let highest = plant.positions.iter().map(|place| place[1]).fold(0.0, f32::max);
            assert!((highest - 1.0).abs() < 1e-6, "{}: {highest} m", shape.name);
            for pairs in [&plant.textures, &plant.bends, &plant.flutters] {
                assert_eq!(pairs.len(), count);
                assert!(
                    pairs.as_flattened().iter().all(|number| (0.0..=1.0).contains(number)),
                    "{}",
                    shape.name
                );
            }
            assert!(plant.triangles.as_flattened().iter().all(|&corner| (corner as usize) < count));
            for normal in &plant.normals {
                let length = normal.iter().map(|number| number * number).sum::<f32>().sqrt();
                assert!((length - 1.0).abs() < 1e-5, "{}: {normal:?}", shape.name);
            }
            assert!(plant.branches.iter().all(|[_, stiffness]| *stiffness > 0.0 && *stiffness <= 1.0));
        }
    }

    #[test]
    fn a_fern_has_fronds_all_around_that_arch_away_from_its_root() {
        let (_, fern) = plant("fern");
        let quarters = fern.positions.iter().fold([0; 4], |mut quarters: [usize; 4], [x, _, z]| {
            quarters[usize::from(*x > 0.0) + 2 * usize::from(*z > 0.0)] += 1;
            quarters
        });
        assert!(quarters.iter().all(|count| *count * 10 > fern.positions.len()), "{quarters:?}");
        let widest = fern.positions.iter().map(|[x, _, z]| x.hypot(*z)).fold(0.0, f32::max);
        assert!((0.8..1.7).contains(&widest), "{widest} m from the root to the farthest leaf");
        let at_root =
            |([x, y, z], [bend, _]): (&[f32; 3], &[f32; 2])| x.hypot(*z) > 0.05 || *y > 0.05 || *bend < 0.05;
        assert!(fern.positions.iter().zip(&fern.bends).all(at_root), "the root stands still");
    }

    #[test]
    fn leaves_hang_on_their_joints_and_flutter_at_their_tips() {
        let (_, fern) = plant("fern");
        let leaves = fern.branches.iter().zip(&fern.flutters).filter(|([level, _], _)| *level >= 1.0);
        let (still, loose) = leaves.fold((0, 0), |(still, loose), (_, [flutter, _])| {
            (still + usize::from(*flutter == 0.0), loose + usize::from(*flutter == 1.0))
        });
        assert!(still > 100 && loose > 100, "{still} vertices at joints, {loose} at tips");
    }

    #[test]
    fn stems_are_no_broader_at_their_top_than_at_their_foot() {
        let (_, fern) = plant("fern");
        let of_stem = |&vertex: &usize| fern.textures[vertex] == Sheet::stem();
        let stems: Vec<_> = (0..fern.positions.len()).filter(of_stem).collect();
        assert!(stems.len() > 40 && stems.len() % 4 == 0, "{} vertices", stems.len());
        for stem in stems.chunks(4) {
            let breadth = |[a, b]: [usize; 2]| {
                let [a, b] = [a, b].map(|corner| fern.positions[stem[corner]]);
                (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt()
            };
            assert!(
                breadth([2, 3]) <= 1.01 * breadth([0, 1]) + 1e-6,
                "{} {}",
                breadth([0, 1]),
                breadth([2, 3])
            );
        }
    }
}
