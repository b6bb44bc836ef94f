//! Affine maps, `x → A x + t`: what an iterated function system is made of.

/// A point in 2D (z = 0) or 3D, in units of the fractal.
pub type Point = [f64; 3];

/// An affine map. A 2D map has zeros in its third row and column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// `A`, row by row.
    pub linear: [[f64; 3]; 3],
    /// `t`.
    pub offset: Point,
}

impl Map {
    /// Leaves every point where it is.
    pub const IDENTITY: Self =
        Self { linear: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], offset: [0.0; 3] };

    /// `(a x + b y + e, c x + d y + f)`, in the order in which Barnsley prints them: a, b, c, d, e, f.
    pub const fn planar([a, b, c, d, e, f]: [f64; 6]) -> Self {
        Self { linear: [[a, b, 0.0], [c, d, 0.0], [0.0; 3]], offset: [e, f, 0.0] }
    }

    /// From the three rows of `A`, each followed by its part of `t`.
    pub const fn spatial([x, y, z]: [[f64; 4]; 3]) -> Self {
        Self {
            linear: [[x[0], x[1], x[2]], [y[0], y[1], y[2]], [z[0], z[1], z[2]]],
            offset: [x[3], y[3], z[3]],
        }
    }

    /// The image of a point.
    #[inline]
    pub fn at(&self, point: Point) -> Point {
        let row = |i: usize| {
            let [a, b, c] = self.linear[i];
            a * point[0] + b * point[1] + c * point[2] + self.offset[i]
        };
        [row(0), row(1), row(2)]
    }

    /// The image of a difference of points.
    #[inline]
    pub fn turn(&self, difference: Point) -> Point {
        let row = |i: usize| dot(self.linear[i], difference);
        [row(0), row(1), row(2)]
    }

    /// This map after another: `self ∘ inner`.
    #[must_use]
    #[inline]
    pub fn after(&self, inner: &Self) -> Self {
        let mut linear = [[0.0; 3]; 3];
        for (row, outer) in linear.iter_mut().zip(self.linear) {
            for (column, entry) in row.iter_mut().enumerate() {
                *entry = (0..3).map(|k| outer[k] * inner.linear[k][column]).sum();
            }
        }
        Self { linear, offset: self.at(inner.offset) }
    }

    /// The same map seen through a change of units, `x → scale x + shift` of every point.
    #[must_use]
    pub fn conjugate(&self, scale: f64, shift: Point) -> Self {
        let moved = self.turn(shift);
        let offset = std::array::from_fn(|i| scale * self.offset[i] + shift[i] - moved[i]);
        Self { linear: self.linear, offset }
    }

    /// Whether it maps the plane z = 0 onto itself and space onto that plane.
    pub fn is_planar(&self) -> bool {
        self.linear[2] == [0.0; 3] && self.offset[2] == 0.0 && self.linear.iter().all(|row| row[2] == 0.0)
    }

    /// How much it lengthens what it lengthens most: the greatest singular value of `A`.
    pub fn ratio(&self) -> f64 {
        let [[a, b, _], [c, d, _], _] = self.linear;
        if self.is_planar() {
            // Half sum and half difference of the singular values, without cancelling.
            let sum = (a + d).hypot(b - c);
            let difference = (a - d).hypot(b + c);
            return 0.5 * (sum + difference);
        }
        greatest_eigenvalue(self.gram()).sqrt()
    }

    /// `Aᵀ A`.
    fn gram(&self) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| self.linear[k][i] * self.linear[k][j]).sum())
        })
    }

    /// How much it scales areas (in 2D) or volumes.
    pub fn determinant(&self) -> f64 {
        let [x, y, z] = self.linear;
        if self.is_planar() { x[0] * y[1] - x[1] * y[0] } else { dot(x, cross(y, z)) }
    }

    /// The point that it leaves where it is; `None` where `1 - A` has no inverse.
    pub fn fixed_point(&self) -> Option<Point> {
        let rows: [Point; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j) - self.linear[i][j]));
        let columns: [Point; 3] = std::array::from_fn(|j| std::array::from_fn(|i| rows[i][j]));
        let determinant = dot(columns[0], cross(columns[1], columns[2]));
        let [u, v, w] = columns;
        let t = self.offset;
        let solved = [
            dot(t, cross(v, w)) / determinant,
            dot(u, cross(t, w)) / determinant,
            dot(u, cross(v, t)) / determinant,
        ];
        // A plus zero instead of a minus zero, so that a plant's root is the origin to the bit.
        solved.iter().all(|x| x.is_finite()).then(|| solved.map(|x| x + 0.0))
    }

    /// Whether all its numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.linear.iter().flatten().chain(&self.offset).all(|x| x.is_finite())
    }
}

/// The inner product.
#[inline]
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The distance of two points.
#[inline]
pub fn distance(a: Point, b: Point) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dot(d, d).sqrt()
}

/// Entries off the diagonal, beside those on it, that are the rounding of the products of which they are sums: as much as
/// they change an eigenvalue by at most.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Of a symmetric matrix, by Jacobi's rotations: each makes one entry off the diagonal 0. Maps that turn and scale have none
/// there, and others hardly any after nine rotations.
fn greatest_eigenvalue(mut matrix: [[f64; 3]; 3]) -> f64 {
    for round in 0..24 {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][round % 3];
        rotate(&mut matrix, p, q);
    }
    matrix[0][0].max(matrix[1][1]).max(matrix[2][2]).max(0.0)
}

fn rotate(matrix: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if matrix[p][q].abs() <= ROUNDING * (matrix[p][p] + matrix[q][q]) {
        return;
    }
    let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
    let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    for row in matrix.iter_mut() {
        (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
    }
    let (old_p, old_q) = (matrix[p], matrix[q]);
    for k in 0..3 {
        matrix[p][k] = cosine * old_p[k] - sine * old_q[k];
        matrix[q][k] = sine * old_p[k] + cosine * old_q[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_map() -> impl Strategy<Value = Map> {
        prop::array::uniform3(prop::array::uniform4(-1.0..1.0_f64)).prop_map(Map::spatial)
    }

    fn any_planar() -> impl Strategy<Value = Map> {
        prop::array::uniform6(-1.0..1.0_f64).prop_map(Map::planar)
    }

    proptest! {
        #[test]
        fn no_direction_is_lengthened_beyond_the_ratio_and_one_reaches_it(map in prop_oneof![any_map(), any_planar()]) {
            let ratio = map.ratio();
            let lengths: Vec<f64> = directions().map(|u| distance(map.turn(u), [0.0; 3])).collect();
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            prop_assert!(longest <= ratio * (1.0 + 1e-9), "{longest} of {ratio}");
            prop_assert!(longest >= 0.99 * ratio, "{longest} of {ratio}");
        }

        #[test]
        fn a_fixed_point_stays(map in any_map()) {
            if let Some(point) = map.fixed_point() {
                let scale = 1.0 + distance(point, [0.0; 3]);
                prop_assume!(scale < 1e6);
                prop_assert!(distance(map.at(point), point) < 1e-9 * scale * scale);
            }
        }

        #[test]
        fn one_map_after_another_is_both_in_turn(outer in any_map(), inner in any_map(), p in prop::array::uniform3(-2.0..2.0_f64)) {
            prop_assert!(distance(outer.after(&inner).at(p), outer.at(inner.at(p))) < 1e-12);
        }

        #[test]
        fn a_change_of_units_commutes_with_the_map(map in any_map(), p in prop::array::uniform3(-2.0..2.0_f64)) {
            let seen = |p: Point| [0.1 * p[0] + 0.5, 0.1 * p[1], 0.1 * p[2] - 1.0];
            prop_assert!(distance(map.conjugate(0.1, [0.5, 0.0, -1.0]).at(seen(p)), seen(map.at(p))) < 1e-12);
        }
    }

    /// Directions so close together that the longest image is found within a hundredth.
    fn directions() -> impl Iterator<Item = Point> {
        let round = |k: usize, n: usize| std::f64::consts::TAU * k as f64 / n as f64;
        (0..90)
            .flat_map(move |i| {
                (0..45).map(move |j| {
                    let (phi, theta) = (round(i, 90), round(j, 90));
                    [phi.cos() * theta.sin(), phi.sin() * theta.sin(), theta.cos()]
                })
            })
            .chain((0..180).map(move |i| [round(i, 180).cos(), round(i, 180).sin(), 0.0]))
    }
}
