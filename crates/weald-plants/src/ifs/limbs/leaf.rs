//! The form of one leaf: a blade that is folded along its axis, rolls a little about it, and hangs at its tip.

use crate::ifs::map::{Point, cross, dot};

/// Slope of the halves of a leaf away from its axis.
const FOLD: f64 = 0.3;

/// By how much of its length a leaf hangs at its tip.
const DROOP: f64 = 0.16;

/// Greatest roll about its axis, as a slope.
const ROLL: f64 = 0.28;

/// A leaf where it is, flat: the axis at a row, its ends there, and the normal.
pub(super) struct Row {
    pub(super) axis: Point,
    pub(super) sides: [Point; 2],
    pub(super) normal: Point,
    /// Share of the way along the leaf.
    pub(super) along: f64,
}

/// A side of a row as it is bent, and its normal.
pub(super) fn bent(row: &Row, side: usize, length: f64, chance: f64) -> (Point, Point) {
    let half = difference(row.sides[side], row.axis);
    let width = dot(half, half).sqrt();
    let sign = if side == 0 { -1.0 } else { 1.0 };
    let slope = sign * ROLL * (2.0 * chance - 1.0) - FOLD;
    let place = std::array::from_fn(|i| row.sides[side][i] + slope * width * row.normal[i]);
    let outward = half.map(|x| if width > 0.0 { x / width } else { 0.0 });
    let normal = unit(std::array::from_fn(|i| row.normal[i] - slope * outward[i]));
    (lowered(place, row, length), normal)
}

/// A point of a row as low as it hangs.
pub(super) fn lowered(point: Point, row: &Row, length: f64) -> Point {
    let drop = DROOP * length * row.along * row.along;
    std::array::from_fn(|i| point[i] - drop * row.normal[i])
}

pub(super) fn difference(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(super) fn unit(vector: Point) -> Point {
    let length = dot(vector, vector).sqrt();
    if length > 0.0 { vector.map(|x| x / length) } else { [0.0, 1.0, 0.0] }
}

/// Length of a vector of a vertex.
pub(super) fn length([x, y, z]: [f32; 3]) -> f32 {
    (x * x + y * y + z * z).sqrt()
}

/// Area of a triangle.
pub(super) fn area([a, b, c]: [[f32; 3]; 3]) -> f32 {
    let [u, v] = [b, c].map(|end| std::array::from_fn(|i| f64::from(end[i] - a[i])));
    let across = cross(u, v);
    (0.5 * dot(across, across).sqrt()) as f32
}
