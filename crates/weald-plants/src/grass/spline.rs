//! The smooth stem through the points of a blade: a clamped uniform B-spline.
//!
//! ```text
//! C(t) = Σ N_(i,p)(t) P_i,  i = 0 to n,  p = min(3, n),  knots p+1 times 0, evenly between, p+1 times 1
//! ```
//!
//! Kim and Cho 2009, eq. 8; n is the level, and at level 4 the knots are 0 0 0 0 ½ 1 1 1 1. Levels 1 and 2 have too few
//! points for a cubic and are a line and a parabola, which the source leaves open. The stem ends in its first and last
//! point and lies within their convex hull.
//!
//! For growth over time all levels are put on the knots of level 4, which changes no stem: a [`Spline`] has five points
//! at any level, and between two levels its points go evenly from one to the other. So a blade grows without a jump, and
//! [`clamped`] is what it must be at whole levels. Below level 1 it sprouts: that line, shortened.

use super::curves::mix;
use super::growth::{LEVELS, Point};

/// A stem on the knots 0 0 0 0 ½ 1 1 1 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spline(pub [Point; LEVELS + 1]);

impl Spline {
    /// The stem at a level from 0 to 4, given the points of all levels.
    #[inline]
    pub fn of(points: &[Point; LEVELS + 1], level: f32) -> Self {
        let whole = (level as usize).min(LEVELS - 1);
        let part = (level - whole as f32).clamp(0.0, 1.0);
        let (from, to) = (at_level(points, whole), at_level(points, whole + 1));
        Self(std::array::from_fn(|i| mixed(from[i], to[i], part)))
    }

    /// The point at t, from 0 at the root to 1 at the tip, and the derivative by t.
    #[inline]
    pub fn at(&self, t: f32) -> (Point, Point) {
        let [a, b, c, d, e] = self.0;
        let (before, behind) = (half(b, c), half(c, d));
        let middle = half(before, behind);
        let doubled = t + t;
        if t < 0.5 {
            cubic([a, b, before, middle], doubled)
        } else {
            cubic([middle, behind, d, e], doubled - 1.0)
        }
    }
}

/// The stem of a whole level on the knots of level 4.
#[inline]
fn at_level(points: &[Point; LEVELS + 1], level: usize) -> [Point; LEVELS + 1] {
    let [a, b, c, d, _] = *points;
    match level {
        0 => [a; LEVELS + 1],
        1 => halved([a, mixed(a, b, 1.0 / 3.0), mixed(a, b, 2.0 / 3.0), b]),
        2 => halved([a, mixed(a, b, 2.0 / 3.0), mixed(c, b, 2.0 / 3.0), c]),
        3 => halved([a, b, c, d]),
        _ => *points,
    }
}

/// A cubic arc with a further knot at ½ (Boehm 1980).
#[inline]
fn halved([a, b, c, d]: [Point; 4]) -> [Point; LEVELS + 1] {
    [a, half(a, b), half(b, c), half(c, d), d]
}

/// A cubic arc and its derivative by twice its parameter, after de Casteljau.
#[inline]
fn cubic([a, b, c, d]: [Point; 4], t: f32) -> (Point, Point) {
    let (ab, bc, cd) = (mixed(a, b, t), mixed(b, c, t), mixed(c, d, t));
    let (abc, bcd) = (mixed(ab, bc, t), mixed(bc, cd, t));
    (mixed(abc, bcd, t), [6.0 * (bcd[0] - abc[0]), 6.0 * (bcd[1] - abc[1])])
}

#[inline]
fn mixed(a: Point, b: Point, t: f32) -> Point {
    [mix(a[0], b[0], t), mix(a[1], b[1], t)]
}

#[inline]
fn half(a: Point, b: Point) -> Point {
    [(a[0] + b[0]) * 0.5, (a[1] + b[1]) * 0.5]
}

/// The stem as it is defined, through the points of a whole level; t from 0 to 1. By de Boor's recurrence.
///
/// # Panics
/// Without a point: a bug of the caller.
pub fn clamped(points: &[Point], t: f32) -> Point {
    let last = points.len() - 1;
    let degree = last.min(3);
    let spans = last + 1 - degree;
    let knot = |i: usize| i.saturating_sub(degree).min(spans) as f32 / spans as f32;
    let span = degree + ((t * spans as f32) as usize).min(spans - 1);
    let mut near: Vec<_> = points[span - degree..=span].to_vec();
    for round in 1..=degree {
        for i in (round..=degree).rev() {
            let (low, high) = (knot(span - degree + i), knot(span + i + 1 - round));
            near[i] = mixed(near[i - 1], near[i], (t - low) / (high - low));
        }
    }
    near[degree]
}
