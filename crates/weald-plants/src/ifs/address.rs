//! From a point to its code: which parts of parts hold it.
//!
//! Parts are opened in the order of how near they can come to the point: a part is an affine image of the ball
//! that holds the fractal, so nothing in it is nearer than the distance to its centre less its radius. A point
//! in several parts at once has several codes; the one that is found first is given.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::code::Code;
use super::map::{Map, Point, distance};
use super::system::Ifs;

/// Parts that are opened before a point counts as not found.
const MAX_PARTS: usize = 1_000_000;

/// The code of the point of the fractal nearest to `point`, and that distance, which is 0 to the precision of the
/// code for points of the fractal. The code is as long as those of the fractal's points. `None` where `point` lies
/// further than `tolerance` from the fractal, or a million parts did not decide it.
pub fn code_of(ifs: &Ifs, point: Point, tolerance: f64) -> Option<(Code, f64)> {
    let (centre, radius) = ifs.ball();
    let near = |map: Map, code: Code| {
        let at_least = (distance(map.at(centre), point) - map.ratio() * radius).max(0.0);
        QueuedPart { at_least, code, map }
    };
    let mut queue = BinaryHeap::from([near(Map::IDENTITY, Code::empty(ifs.digits()))]);
    for _ in 0..MAX_PARTS {
        let part = queue.pop()?;
        if part.at_least > tolerance {
            return None;
        }
        if part.code.len() == ifs.code_digits() {
            return Some((part.code, distance(ifs.point(&part.code), point)));
        }
        let parts = ifs.maps().iter().enumerate();
        queue.extend(
            parts.map(|(digit, weighted)| near(part.map.after(&weighted.map), part.code.with(digit as u8))),
        );
    }
    None
}

/// A part, in the order in which parts are opened: the nearest, and of equally near ones the longest code.
#[derive(Clone, Copy, Debug)]
struct QueuedPart {
    at_least: f64,
    code: Code,
    map: Map,
}

impl PartialEq for QueuedPart {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for QueuedPart {}

impl PartialOrd for QueuedPart {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for QueuedPart {
    fn cmp(&self, other: &Self) -> Ordering {
        let nearer = other.at_least.total_cmp(&self.at_least);
        nearer.then(self.code.len().cmp(&other.code.len())).then(other.code.cmp(&self.code))
    }
}
