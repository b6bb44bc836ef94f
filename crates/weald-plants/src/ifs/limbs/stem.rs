//! Stems: flat ribbons that cross, or tubes where the stems of a crown are seen from close by.

use super::leaf::{Row, difference, unit};
use super::limb::Limbs;
use super::place::{Builder, Leaf};
use super::walk::Part;
use crate::ifs::foliage::across;
use crate::ifs::map::{Point, cross};

/// Size of the parts of a crown from which a stem is round from close by, and the last level on which it is: farther off the
/// edges of crossed ribbons are not seen.
const ROUND: f64 = 0.16;
const LAST_ROUND: u32 = 1;

/// Sides of a round stem.
const SIDES: usize = 9;

/// Rings of a stem: how far up it they lie, and how much broader it is there.
const RINGS: [(f64, f64); 2] = [(0.0, 1.0), (1.0, 1.0)];

/// Those of the trunk: it spreads to its roots and goes on below the ground, which on slopes falls away from it.
const RINGS_OF_TRUNK: [(f64, f64); 5] = [(-0.2, 2.2), (0.0, 1.75), (0.03, 1.35), (0.1, 1.1), (1.0, 1.0)];

/// The ends of a stem, how far along its part they are, and half its widths there.
type Stem = ([Point; 2], [f64; 2], [f64; 2]);

impl Builder {
    /// Adds the stem of a part, from its foot to its top, as a view shows it; with a bare stipe below the first.
    pub(super) fn stem(&self, plant: &mut Limbs, leaf: &Leaf<'_>) {
        let Some(ends) = self.shape.stem else { return };
        let flats = ends.map(|end| self.shape.flat(leaf.part.map.at(end)));
        let alongs = ends.map(|end| self.shape.flat(end)[1]);
        let half = self.shape.stem_half_width * leaf.part.size;
        let halves = [half, half * self.shape.taper];
        if self.is_crown() && leaf.part.size >= ROUND {
            self.round_stem(plant, leaf, (flats, alongs, halves));
        } else {
            self.ribbon(plant, leaf, (flats, alongs, halves));
        }
        if leaf.part.branch == 0 && leaf.part.key == 0 && self.stipe > 0.0 {
            let foot = -self.stipe / (1.0 - self.stipe);
            let flats = [[0.0, foot, 0.0], flats[0]];
            self.ribbon(
                plant,
                leaf,
                (flats, [foot, alongs[0]], [half / (self.shape.taper * self.shape.taper), half]),
            );
        }
    }

    /// A stem that is round from close by and two ribbons that cross from farther off, of which those of a view are added; both are
    /// there where one passes into the other.
    fn round_stem(&self, plant: &mut Limbs, leaf: &Leaf<'_>, stem: Stem) {
        let [first, last] = self.levels_of(leaf.part);
        let part = |levels: [u32; 2]| Part { levels, ..*leaf.part };
        if leaf.view == 0 {
            self.tube(plant, &Leaf { part: &part([first, last.min(LAST_ROUND)]), ..*leaf }, stem);
        }
        if last >= LAST_ROUND {
            self.ribbon(plant, &Leaf { part: &part([first.max(LAST_ROUND), last]), ..*leaf }, stem);
        }
    }

    fn tube(&self, plant: &mut Limbs, leaf: &Leaf<'_>, (flats, alongs, halves): Stem) {
        let along = difference(flats[1], flats[0]);
        let right = across(flats[0], flats[1], 0);
        let ahead = unit(cross(right, along));
        let is_trunk = leaf.part.branch == 0 && leaf.part.key == 0;
        let rings: &[_] = if is_trunk { &RINGS_OF_TRUNK } else { &RINGS };
        let first = plant.corners.len() as u32;
        for &(up, broader) in rings {
            let middle = std::array::from_fn(|i| flats[0][i] + up * along[i]);
            let (axis, normal) = self.on_frond(leaf.frond, middle);
            let at = (alongs[0] + up * (alongs[1] - alongs[0])).max(0.0);
            let row = Row { axis, sides: [axis; 2], normal, along: at };
            let half = broader * (halves[0] + up.max(0.0) * (halves[1] - halves[0]));
            for side in 0..SIDES {
                let (sine, cosine) = libm::sincos(std::f64::consts::TAU * side as f64 / SIDES as f64);
                let flat = std::array::from_fn(|i| middle[i] + half * (cosine * right[i] + sine * ahead[i]));
                let rest = self.on_frond(leaf.frond, flat).0;
                plant.corners.push(self.corner(leaf, &row, [rest, axis, unit(difference(rest, axis))]));
            }
        }
        plant.triangles.extend(tube_triangles(first, rings.len() as u32));
    }

    fn ribbon(&self, plant: &mut Limbs, leaf: &Leaf<'_>, (flats, alongs, halves): Stem) {
        let across = across(flats[0], flats[1], leaf.view);
        let first = plant.corners.len() as u32;
        for end in 0..2 {
            let (axis, normal) = self.on_frond(leaf.frond, flats[end]);
            let row = Row { axis, sides: [axis; 2], normal, along: alongs[end] };
            for side in [-halves[end], halves[end]] {
                let flat = std::array::from_fn(|i| flats[end][i] + side * across[i]);
                let rest = self.on_frond(leaf.frond, flat).0;
                plant.corners.push(self.corner(leaf, &row, [rest, axis, normal]));
            }
        }
        plant.triangles.extend([[first, first + 1, first + 2], [first + 2, first + 1, first + 3]]);
    }
}

/// The triangles between so many rings.
fn tube_triangles(first: u32, rings: u32) -> impl Iterator<Item = [u32; 3]> {
    let sides = SIDES as u32;
    let corner = move |ring: u32, side: u32| first + ring * sides + side % sides;
    (1..rings).flat_map(move |ring| {
        (0..sides).flat_map(move |side| {
            let ([a, b], [c, d]) = (
                [side, side + 1].map(|side| corner(ring - 1, side)),
                [side, side + 1].map(|side| corner(ring, side)),
            );
            [[a, b, c], [b, d, c]]
        })
    })
}
