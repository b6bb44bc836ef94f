//! The box that a fractal fills.

use super::map::{Map, Point, distance, dot};

/// Error of the box, as a share of the radius of a ball that holds the fractal.
const TOLERANCE: f64 = 1e-8;

/// Parts of one size that are followed: those that may reach furthest. Sets with straight sides have very many that
/// reach equally far, and any of them will do.
const BEAM: usize = 48;

/// Most rounds. Each begins with the box of the one before, which holds the fractal and fits it better than a ball.
const MAX_ITERATIONS: usize = 8;

/// A box that holds the fractal: least and greatest coordinates.
type Bounds = [Point; 2];

/// A fractal as copies of itself.
pub(super) struct Copies<'a> {
    /// The map of each copy.
    pub(super) maps: &'a [Map],
    /// One of its points.
    pub(super) root: Point,
    /// Centre and radius of a ball that holds it.
    pub(super) ball: (Point, f64),
}

/// Least and greatest coordinates of the fractal's points, or somewhat beyond them where that many rounds and parts
/// do not decide.
pub(super) fn bounds(ifs: &Copies<'_>) -> Bounds {
    let (centre, radius) = ifs.ball;
    let mut bounds = [centre.map(|x| x - radius), centre.map(|x| x + radius)];
    for _ in 0..MAX_ITERATIONS {
        let (tighter, open) = tightened(ifs, &bounds);
        let side = distance(bounds[0], bounds[1]);
        bounds = tighter;
        if open <= TOLERANCE * side {
            break;
        }
    }
    bounds
}

/// The box as far as it can be told within one that holds the fractal, and how far it may still be too wide.
fn tightened(ifs: &Copies<'_>, within: &Bounds) -> (Bounds, f64) {
    let mut bounds = *within;
    let mut open = 0.0_f64;
    for axis in 0..3 {
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let mut direction = [0.0; 3];
            direction[axis] = sign;
            let [known, most] = reach(ifs, direction, within);
            bounds[side][axis] = sign * most;
            open = open.max(most - known);
        }
    }
    (bounds, open)
}

/// How far the fractal reaches in a direction of length 1, at least and at most: parts are opened as long as they may
/// reach further than a point that is known.
fn reach(ifs: &Copies<'_>, direction: Point, within: &Bounds) -> [f64; 2] {
    let reaching = |map: Map| {
        let seen: Point = std::array::from_fn(|j| (0..3).map(|i| map.linear[i][j] * direction[i]).sum());
        let furthest = |i: usize| (seen[i] * within[0][i]).max(seen[i] * within[1][i]);
        let at_most = dot(map.offset, direction) + furthest(0) + furthest(1) + furthest(2);
        PartReach { at_least: dot(map.at(ifs.root), direction), at_most, map }
    };
    let fine = TOLERANCE * distance(within[0], within[1]);
    let mut front = vec![reaching(Map::IDENTITY)];
    let mut known = front[0].at_least;
    let mut most = known;
    while front.iter().any(|part| part.at_most - part.at_least > fine) {
        let parts = front.iter().flat_map(|part| ifs.maps.iter().map(move |map| part.map.after(map)));
        front = parts.map(reaching).collect();
        known = front.iter().map(|part| part.at_least).fold(known, f64::max);
        front.retain(|part| part.at_most > known);
        front.sort_by(|a, b| b.at_most.total_cmp(&a.at_most));
        // What is not followed may reach as far as it may.
        most = front.iter().skip(BEAM).map(|part| part.at_most).fold(most, f64::max);
        front.truncate(BEAM);
    }
    let left = front.iter().map(|part| part.at_most);
    [known, left.fold(most, f64::max).max(known)]
}

/// A part: how far one of its points reaches, and how far others may.
#[derive(Clone, Copy, Debug)]
struct PartReach {
    at_least: f64,
    at_most: f64,
    map: Map,
}
