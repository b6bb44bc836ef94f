//! The hull of a crown, in place of its leaves where it is seen so small that these are less than a pixel.

use super::leaf::unit;
use super::limb::{Corner, Limbs};
use super::outline::Outline;
use crate::ifs::map::Point;
use weald_core::random::{hash2, unit as unit_of};

/// Rings of corners around a stem, closed by a point above and one below.
pub(super) struct Hull {
    /// The level of detail that it is.
    pub(super) level: u32,
    /// Corners of a ring.
    sides: usize,
    /// Shares of the height at which rings lie.
    rings: &'static [f64],
}

/// Those of all levels that have one, finest first.
pub(super) const HULLS: [Hull; 2] = [
    Hull { level: 3, sides: 7, rings: &[0.07, 0.2, 0.4, 0.62, 0.82, 0.94] },
    Hull { level: 4, sides: 4, rings: &[0.12, 0.4, 0.75] },
];

/// Share by which corners stand in or out by chance, so that a crown is not turned on a lathe.
const ROUGH: f64 = 0.22;

/// How much a crown looks upward beside outward.
const UPWARD: f64 = 0.55;

/// Greatest tone of its corners: the light between leaves is lost, of which a hull has none.
const DARK: f64 = 0.3;

/// Share of the light of a place that leaves there see, which stand before each other.
pub(super) const AMONG_LEAVES: f32 = 0.8;

impl Hull {
    /// Adds it to a plant of such an outline; `placed` says where points of the outline are.
    pub(super) fn add(&self, plant: &mut Limbs, outline: &Outline, placed: impl Fn(Point) -> Point) {
        let first = plant.corners.len() as u32;
        let foot = 0.5 * self.rings[0];
        self.corner(plant, &placed, [0.0, foot, 0.0], -0.8);
        for (ring, &along) in self.rings.iter().enumerate() {
            for side in 0..self.sides {
                let upward = UPWARD * (0.3 + along);
                self.corner(plant, &placed, self.flat(outline, [ring, side], along), upward);
            }
        }
        self.corner(plant, &placed, [0.0, 1.0, 0.0], 1.0);
        plant.triangles.extend(self.triangles().map(|triangle| triangle.map(|corner| first + corner)));
    }

    /// A corner of a ring on the outline, as the front and the right side show it.
    fn flat(&self, outline: &Outline, [ring, side]: [usize; 2], along: f64) -> Point {
        // Rings are turned by half a side against each other.
        let turn = std::f64::consts::TAU * (side as f64 + 0.5 * (ring % 2) as f64) / self.sides as f64;
        let (sine, cosine) = libm::sincos(turn);
        let chance = unit_of(hash2(u64::from(self.level), ring as i64, side as i64));
        let rough = 1.0 + ROUGH * (2.0 * chance - 1.0);
        let reach = |view: usize, towards: f64| {
            let [left, right] = outline.at(view, along);
            rough * towards * if towards < 0.0 { -left } else { right }
        };
        [reach(0, cosine), along, reach(1, sine)]
    }

    fn corner(&self, plant: &mut Limbs, placed: &impl Fn(Point) -> Point, flat: Point, upward: f64) {
        let [x, y, z] = placed(flat);
        let [stem_x, _, stem_z] = placed([0.0, flat[1], 0.0]);
        let out = [x - stem_x, 0.0, z - stem_z];
        let reach = (out[0] * out[0] + out[2] * out[2]).sqrt().max(1e-9);
        let normal = unit([out[0] / reach, upward, out[2] / reach]);
        let number = plant.corners.len() as u64;
        plant.corners.push(Corner {
            rest: [x, y, z].map(|at| at as f32),
            axis: [stem_x, y, stem_z].map(|at| at as f32),
            normal: normal.map(|part| part as f32),
            along: flat[1] as f32,
            limb: 0,
            levels: [self.level; 2],
            is_stem: false,
            up: 0.0,
            side: 0,
            tone: (DARK * unit_of(hash2(number, i64::from(self.level), 12))) as f32,
            open: 1.0,
        });
    }

    /// Of the foot, the rings and the tip, in this order.
    fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let (sides, rings) = (self.sides as u32, self.rings.len() as u32);
        let corner = move |ring: u32, side: u32| 1 + ring * sides + side % sides;
        let tip = 1 + rings * sides;
        let ends = (0..sides)
            .flat_map(move |side| [[0, side], [tip, side]].map(|[end, side]| (end, side)))
            .map(move |(end, side)| {
                let ring = if end == 0 { 0 } else { rings - 1 };
                [end, corner(ring, side), corner(ring, side + 1)]
            });
        let between = (0..rings - 1).flat_map(move |ring| {
            (0..sides).flat_map(move |side| {
                // The next ring is turned forward from an even one, backward from an odd one.
                let shift = ring % 2;
                let [a, b] = [corner(ring, side), corner(ring, side + 1)];
                let [c, d] = [corner(ring + 1, side + shift), corner(ring + 1, side + shift + sides - 1)];
                [[a, b, c], [a, c, d]]
            })
        });
        ends.chain(between)
    }
}
