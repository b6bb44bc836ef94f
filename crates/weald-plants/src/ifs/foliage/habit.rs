//! How a plant stands in space.

use crate::ifs::map::Point;
use crate::ifs::system::Ifs;
use weald_core::random::{hash2, unit};

/// How a shape becomes a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Habit {
    /// So many flat fronds that arch away from the root, as a fern has them.
    Arching(u32),
    /// So many fronds that have their own arch, and lean away from the root.
    Leaning(u32),
    /// So many planes that cross in the stem.
    Crossed(u32),
    /// One 3D shape.
    Single,
}

/// One of the fronds or planes of a plant.
pub(in crate::ifs) struct Frond {
    /// Its number.
    pub(in crate::ifs) number: i64,
    /// Its phase in the wind, 0 to 1.
    pub(in crate::ifs) phase: f64,
    azimuth: f64,
    length: f64,
    /// Angle from upright at the root, and how much more at the tip, in radians.
    lean: f64,
    arch: f64,
}

/// Angle from upright at the root, and by how much more a frond turns in its length, in radians: of every other one, which is an inner
/// one, and of the outer ones, which lie lower and whose tips hang. The funnel is three times as far across as high; fronds that arch
/// down to the ground are five times so, and from some way off stand like the crown of a palm.
const INNER: (f64, f64) = (0.36, 0.90);
const OUTER: (f64, f64) = (0.70, 1.0);

/// By how much the halves of a frond rise from its midrib.
const FOLD: f64 = 0.22;

impl Habit {
    /// The habit that a shape grows by, with another number of fronds or planes where one is given: ferns arch, other
    /// flat shapes cross, 3D shapes are not repeated.
    pub fn of(ifs: &Ifs, fronds: Option<u32>) -> Self {
        let count = |usual: u32| fronds.unwrap_or(usual);
        match ifs.name() {
            "fern" | "cyclosorus" | "culcita" | "fishbone" => Self::Arching(count(8)),
            "fern-3d" => Self::Leaning(count(8)),
            _ if ifs.is_planar() => Self::Crossed(count(3)),
            _ => fronds.filter(|&count| count > 1).map_or(Self::Single, Self::Leaning),
        }
    }

    /// Whether fronds grow from a root one by one.
    pub(in crate::ifs) fn is_rosette(self) -> bool {
        matches!(self, Self::Arching(_) | Self::Leaning(_))
    }

    /// Size, as a share of the plant, below which a branch is a leaf.
    pub(in crate::ifs) fn leaf(self) -> f64 {
        match self {
            Self::Arching(_) | Self::Leaning(_) => 0.4,
            Self::Crossed(_) | Self::Single => 0.25,
        }
    }

    /// Its fronds or planes, no two alike.
    pub(in crate::ifs) fn fronds(self) -> Vec<Frond> {
        let (count, turn, is_grown) = match self {
            Self::Arching(count) | Self::Leaning(count) => (count, std::f64::consts::TAU, true),
            Self::Crossed(count) => (count, std::f64::consts::PI, false),
            Self::Single => (1, 0.0, false),
        };
        let frond = |number: i64| {
            let random =
                |purpose: u64| if is_grown { 2.0 * unit(hash2(purpose, number, 7)) - 1.0 } else { 0.0 };
            let is_outer = is_grown && number % 2 == 1;
            let (lean, arch) = if is_outer { OUTER } else { INNER };
            Frond {
                number,
                phase: unit(hash2(4, number, 7)),
                azimuth: turn / f64::from(count) * (number as f64 + 0.3 * random(0)),
                length: 0.92 + 0.16 * random(1),
                lean: lean + 0.12 * random(2),
                arch: arch + 0.2 * random(3),
            }
        };
        (0..i64::from(count)).map(frond).collect()
    }

    /// Where a point of the flat shape comes to lie, and the normal there.
    pub(in crate::ifs) fn placed(self, frond: &Frond, [x, y, z]: Point) -> (Point, Point) {
        let (sine, cosine) = libm::sincos(frond.azimuth);
        let around =
            |out: f64, up: f64, side: f64| [cosine * out - sine * side, up, sine * out + cosine * side];
        let arch = match self {
            Self::Arching(_) => frond.arch,
            Self::Leaning(_) => 0.0,
            Self::Crossed(_) | Self::Single => {
                let place = around(z, y, x);
                return (place, rounded(place));
            }
        };
        let along = Along::at(y, frond.lean, arch);
        let rise = z + FOLD * x.abs();
        let [out, up] = [0, 1].map(|axis| frond.length * (along.place[axis] + rise * along.normal[axis]));
        let normal = around(along.normal[0], along.normal[1], -FOLD * x.signum());
        (around(out, up, frond.length * x), unit_vector(normal))
    }
}

/// A place along an arch, outward and upward.
struct Along {
    place: [f64; 2],
    /// Of the upper side.
    normal: [f64; 2],
}

impl Along {
    /// An arc that leaves the root at an angle of `lean` from upright and turns evenly by `arch` a unit of length.
    fn at(along: f64, lean: f64, arch: f64) -> Self {
        let (sine, cosine) = libm::sincos(lean + arch * along);
        let (first_sine, first_cosine) = libm::sincos(lean);
        let place = if arch.abs() < 1e-9 {
            [first_sine * along, first_cosine * along]
        } else {
            [(first_cosine - cosine) / arch, (sine - first_sine) / arch]
        };
        Self { place, normal: [-cosine, sine] }
    }
}

/// A crown is lit as the round thing that it stands for.
fn rounded([x, y, z]: Point) -> Point {
    unit_vector([x, y - 0.35 + 0.5, z])
}

fn unit_vector(vector: Point) -> Point {
    let length = vector.iter().map(|number| number * number).sum::<f64>().sqrt();
    if length > 0.0 { vector.map(|number| number / length) } else { [0.0, 1.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_side_of_an_arch_stands_at_right_angles_to_it() {
        for (lean, arch) in [(0.4, 1.2), (0.6, 0.0), (0.2, 2.0)] {
            let [before, here, after] = [0.299_999, 0.3, 0.300_001].map(|along| Along::at(along, lean, arch));
            let ahead = [0, 1].map(|axis| (after.place[axis] - before.place[axis]) / 2e-6);
            let [out, up] = here.normal;
            assert!((ahead[0] * ahead[0] + ahead[1] * ahead[1] - 1.0).abs() < 1e-6, "a length is a length");
            assert!((ahead[0] * out + ahead[1] * up).abs() < 1e-6 && up > 0.0, "{ahead:?} {:?}", here.normal);
        }
    }
}
