//! The box that a fractal fills.

use super::map::{Map, Point, distance, dot};
use super::system::Ifs;

/// Error of the box, as a share of the radius of a ball that holds the fractal.
const TOLERANCE: f64 = 1e-8;

/// Parts of one size that are followed: those that may reach furthest. Sets with straight sides have very many that
/// reach equally far, and any of them will do.
const BEAM: usize = 48;

/// Least and greatest coordinates of the fractal's points.
pub(super) fn bounds(ifs: &Ifs) -> [Point; 2] {
    let axis = |i: usize, sign: f64| {
        let mut direction = [0.0; 3];
        direction[i] = sign;
        sign * reach(ifs, direction)
    };
    [std::array::from_fn(|i| axis(i, -1.0)), std::array::from_fn(|i| axis(i, 1.0))]
}

/// How far the fractal reaches in a direction of length 1: parts are opened as long as they may reach further than a
/// point that is known.
fn reach(ifs: &Ifs, direction: Point) -> f64 {
    let (centre, radius) = ifs.ball();
    let reaching = |map: Map| {
        let column = |j: usize| (0..3).map(|i| map.linear[i][j] * direction[i]).sum::<f64>();
        let spread = distance([column(0), column(1), column(2)], [0.0; 3]) * radius;
        Reaching { at_least: dot(map.at(centre), direction), spread, map }
    };
    let mut known = dot(centre, direction);
    let mut front = vec![reaching(Map::IDENTITY)];
    while front.iter().any(|part| part.spread > TOLERANCE * radius) {
        let parts = front.iter().flat_map(|part| ifs.maps().iter().map(move |map| part.map.after(&map.map)));
        front = parts.map(reaching).collect();
        known = front.iter().map(|part| part.at_least).fold(known, f64::max);
        front.retain(|part| part.at_least + part.spread > known);
        front.sort_by(|a, b| (b.at_least + b.spread).total_cmp(&(a.at_least + a.spread)));
        front.truncate(BEAM);
    }
    known
}

/// A part: how far a point of it reaches, and how much further others may.
#[derive(Clone, Copy, Debug)]
struct Reaching {
    at_least: f64,
    spread: f64,
    map: Map,
}
