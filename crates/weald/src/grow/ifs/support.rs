//! The box that a fractal fills, and which of its parts can hold a point.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::map::{Map, Point, distance, dot};
use super::system::Ifs;

/// Error of the box, as a share of the radius of a ball that holds the fractal.
const TOLERANCE: f64 = 1e-9;

/// Parts that are looked at for one side of the box.
const MOST_PARTS: usize = 200_000;

/// Least and greatest coordinates of the fractal's points.
pub(super) fn bounds(ifs: &Ifs) -> [Point; 2] {
    let axis = |i: usize, sign: f64| {
        let mut direction = [0.0; 3];
        direction[i] = sign;
        sign * reach(ifs, direction)
    };
    [std::array::from_fn(|i| axis(i, -1.0)), std::array::from_fn(|i| axis(i, 1.0))]
}

/// How far the fractal reaches in a direction of length 1: parts are opened in the order in which they may reach
/// furthest, until that is known to a billionth.
fn reach(ifs: &Ifs, direction: Point) -> f64 {
    let (centre, radius) = ifs.ball();
    let ranked = |map: Map| {
        let column = |j: usize| (0..3).map(|i| map.linear[i][j] * direction[i]).sum::<f64>();
        let spread = distance([column(0), column(1), column(2)], [0.0; 3]) * radius;
        Ranked { value: dot(map.at(centre), direction) + spread, spread, map }
    };
    let mut queue = BinaryHeap::from([ranked(Map::IDENTITY)]);
    for _ in 0..MOST_PARTS {
        let Some(part) = queue.pop() else { break };
        if part.spread <= TOLERANCE * radius {
            return part.value - part.spread;
        }
        queue.extend(ifs.maps().iter().map(|weighted| ranked(part.map.after(&weighted.map))));
    }
    queue.pop().map_or(radius, |part| part.value)
}

/// A part, in the order of how far it may reach.
#[derive(Clone, Copy, Debug)]
struct Ranked {
    value: f64,
    spread: f64,
    map: Map,
}

impl PartialEq for Ranked {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ranked {}

impl PartialOrd for Ranked {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ranked {
    fn cmp(&self, other: &Self) -> Ordering {
        self.value.total_cmp(&other.value)
    }
}
