//! Symmetries of a flame: xforms that turn or mirror the plane about the origin, and contract nothing.
//!
//! With maps `F_i` of shares `p_i` and symmetries `g_k` of shares `q_k`, the density of the points is the `μ` for which
//! `μ = Σ p_i F_i μ + Σ q_k g_k μ`. The `g_k` generate a finite group `G`; solved for `μ` it is `Σ c_g p_i (g F_i) μ`, with
//! `c = δ + q * c` on the group. So the maps `g F_i` with shares `c_g p_i` draw the same shape with the same density, and
//! they contract. flam3 writes `<symmetry kind="n"/>` (`n` turns; a mirror as well where `n` is negative) and the xforms of
//! it side by side; both count, as when flam3 reads them.

use std::f64::consts::TAU;

use super::super::code::MAX_MAPS;
use super::super::map::Map;
use super::element::Element;
use weald_io::Fault;

/// A map and its share of the points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub(super) map: Map,
    /// All of a flame sum to 1.
    pub(super) share: f64,
}

/// Numbers of flam3 have six decimals.
const TOLERANCE: f64 = 4e-6;

/// In turns. Two angles that are not one differ by more in any group that is small enough.
const SAME_ANGLE: f64 = 2e-6;

/// Whether a map turns or mirrors the plane about the origin.
pub(super) fn is_isometry(map: &Map) -> bool {
    let [[a, b, _], [c, d, _], _] = map.linear;
    let errors = [a * a + c * c - 1.0, b * b + d * d - 1.0, a * b + c * d, map.offset[0], map.offset[1]];
    errors.iter().all(|error| error.abs() <= TOLERANCE)
}

/// The maps of a `symmetry` element, as flam3 adds them.
pub(super) fn of_kind(element: Element<'_>) -> Result<Vec<Map>, Fault> {
    let kind = element.number("kind")?.unwrap_or(0.0);
    let order = kind.abs() as usize;
    if kind == 0.0 || kind.fract() != 0.0 || order > MAX_MAPS {
        return Err(element.fault(&format!(
            "`kind` is {kind}; it must be a whole number from -{MAX_MAPS} to {MAX_MAPS}, and not 0, which is random"
        )));
    }
    let mirror = (kind < 0.0).then_some(Map::planar([-1.0, 0.0, 0.0, 1.0, 0.0, 0.0]));
    Ok(mirror.into_iter().chain((1..order).map(|k| turn(k as f64 / order as f64))).collect())
}

/// The maps that contract, each followed by every symmetry: those with none first.
///
/// # Errors
/// A sentence where the symmetries make no small group.
pub(super) fn expanded(shares: &[Share]) -> Result<Vec<Share>, String> {
    let (symmetries, maps): (Vec<Share>, Vec<Share>) =
        shares.iter().partition(|share| is_isometry(&share.map));
    if symmetries.is_empty() {
        return Ok(maps);
    }
    let group = Group::of(&symmetries)?;
    if group.len() * maps.len() > MAX_MAPS {
        let (order, count) = (group.len(), maps.len());
        return Err(format!(
            "its symmetries turn {count} xforms into {}, and at most {MAX_MAPS} fit a code",
            order * count
        ));
    }
    let weights = group.weights(&symmetries);
    let followed = |(place, weight): (usize, f64)| {
        let symmetry = group.element(place);
        maps.iter().map(move |map| Share { map: symmetry.after(&map.map), share: weight * map.share })
    };
    Ok(weights.into_iter().enumerate().flat_map(followed).collect())
}

fn turn(turns: f64) -> Map {
    let (sin, cos) = (libm::sin(TAU * turns), libm::cos(TAU * turns));
    Map::planar([cos, -sin, sin, cos, 0.0, 0.0])
}

/// Its angle in turns, of a mirror that of the turn after the mirror of `y`; and whether it mirrors.
fn angle(map: &Map) -> (f64, bool) {
    (libm::atan2(map.linear[1][0], map.linear[0][0]) / TAU, map.determinant() < 0.0)
}

/// A finite group of turns by whole multiples of one angle, and of a mirror followed by those.
struct Group {
    /// Number of turns.
    order: usize,
    /// The angle of the mirror.
    mirror: Option<f64>,
}

impl Group {
    fn of(symmetries: &[Share]) -> Result<Self, String> {
        let angles: Vec<_> = symmetries.iter().map(|share| angle(&share.map)).collect();
        let mirror = angles.iter().find(|(_, mirrors)| *mirrors).map(|(angle, _)| *angle);
        let turns: Vec<f64> = angles
            .iter()
            .map(|(angle, mirrors)| if *mirrors { angle - mirror.unwrap_or(0.0) } else { *angle })
            .collect();
        let fits = |order: &usize| turns.iter().all(|turn| off_multiple(*turn, *order) <= SAME_ANGLE);
        let order = (1..=MAX_MAPS).find(fits).ok_or_else(|| {
            format!("its symmetries turn by no share of a circle with a whole number up to {MAX_MAPS}")
        })?;
        Ok(Self { order, mirror })
    }

    fn len(&self) -> usize {
        self.order * (1 + usize::from(self.mirror.is_some()))
    }

    /// Turns first, then those after the mirror.
    fn element(&self, place: usize) -> Map {
        let turned = turn((place % self.order) as f64 / self.order as f64);
        let mirrored =
            |angle: f64| turned.after(&turn(angle)).after(&Map::planar([1.0, 0.0, 0.0, -1.0, 0.0, 0.0]));
        if place < self.order { turned } else { self.mirror.map_or(turned, mirrored) }
    }

    fn place(&self, map: &Map) -> usize {
        let (angle, mirrors) = angle(map);
        let turned = if mirrors { angle - self.mirror.unwrap_or(0.0) } else { angle };
        let steps = (turned * self.order as f64).round().rem_euclid(self.order as f64) as usize;
        steps % self.order + if mirrors { self.order } else { 0 }
    }

    /// One element after another.
    fn product(&self, outer: usize, inner: usize) -> usize {
        let order = self.order;
        let (steps, inner_steps) = (outer % order, inner % order);
        // A mirror turns the other way round what it follows.
        let sum = if outer < order { steps + inner_steps } else { steps + order - inner_steps };
        sum % order + if (outer < order) == (inner < order) { 0 } else { order }
    }

    /// The `c` of all elements: a linear system that is dominated by its diagonal, so no pivots are looked for.
    fn weights(&self, symmetries: &[Share]) -> Vec<f64> {
        let count = self.len();
        let mut matrix = vec![vec![0.0; count]; count];
        for (place, row) in matrix.iter_mut().enumerate() {
            row[place] = 1.0;
        }
        for symmetry in symmetries {
            let outer = self.place(&symmetry.map);
            for inner in 0..count {
                matrix[self.product(outer, inner)][inner] -= symmetry.share;
            }
        }
        let mut right = vec![0.0; count];
        right[0] = 1.0;
        solved(matrix, right)
    }
}

/// How far, in turns, an angle is from a multiple of a share of the circle.
fn off_multiple(angle: f64, order: usize) -> f64 {
    let steps = angle * order as f64;
    (steps - steps.round()).abs() / order as f64
}

/// The solution of a linear system, by elimination.
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    for column in 0..right.len() {
        let (above, below) = matrix.split_at_mut(column + 1);
        let pivot = &above[column];
        for (offset, row) in below.iter_mut().enumerate() {
            let factor = row[column] / pivot[column];
            for (entry, from) in row.iter_mut().zip(pivot).skip(column) {
                *entry -= factor * from;
            }
            right[column + 1 + offset] -= factor * right[column];
        }
    }
    for row in (0..right.len()).rev() {
        let known: f64 = (row + 1..right.len()).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right
}
