//! Delaunay triangulation of cells of a grid, one point after the other.
//!
//! A point splits the triangle it lies in, or the two whose edge it lies on. Then each edge across from it is
//! flipped whose two triangles have a circumcircle with the other's corner in it: for `a b c` anticlockwise, `d` lies
//! inside where
//!
//! ```text
//! | ax-dx  ay-dy  (ax-dx)²+(ay-dy)² |
//! | bx-dx  by-dy  (bx-dx)²+(by-dy)² | > 0
//! | cx-dx  cy-dy  (cx-dx)²+(cy-dy)² |
//! ```
//!
//! Charles L. Lawson, "Software for C¹ surface interpolation" (1977), and Leonidas Guibas and Jorge Stolfi,
//! "Primitives for the manipulation of general subdivisions and the computation of Voronoi diagrams", ACM
//! Transactions on Graphics 4 (1985), doi:10.1145/282918.282923. What differs: coordinates are whole, so all tests
//! are exact, and where four points lie on one circle a corner without data gets no edge that it need not have.

/// A cell by column and row.
pub(super) type Point = [u32; 2];

/// Stands for the triangle beyond the outline.
const OUTSIDE: u32 = u32::MAX;

/// A triangulation of a rectangle. Triangles run anticlockwise as seen on a map, where rows go south.
#[derive(Debug)]
pub(super) struct Delaunay {
    points: Vec<Point>,
    /// Three a triangle. Half-edge `e` goes from `corners[e]` to the next corner of its triangle.
    corners: Vec<u32>,
    /// The half-edge on the other side of each.
    twins: Vec<u32>,
    /// Triangles that were made or changed since they were last taken.
    changed: Vec<u32>,
    /// Half-edges still to be tested.
    doubtful: Vec<u32>,
    /// Which of the first four points, the corners of the rectangle, have no data.
    void: [bool; 4],
}

impl Delaunay {
    /// Two triangles over `columns` × `rows` cells, at least two each. `is_void` says which cells have no data.
    pub(super) fn new(columns: u32, rows: u32, is_void: impl Fn(Point) -> bool) -> Self {
        let points = vec![[0, 0], [columns - 1, 0], [0, rows - 1], [columns - 1, rows - 1]];
        let void = [points[0], points[1], points[2], points[3]].map(is_void);
        // The diagonal is the second half-edge of both.
        let corners = if void[1] || void[2] { vec![1, 0, 3, 2, 3, 0] } else { vec![0, 2, 1, 3, 1, 2] };
        let mut twins = vec![OUTSIDE; 6];
        (twins[1], twins[4]) = (4, 1);
        Self { points, corners, twins, changed: vec![0, 1], doubtful: Vec::new(), void }
    }

    /// All points in the order in which they came.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// Corners of all triangles.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.corners.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]])
    }

    /// Where the corners of a triangle lie.
    pub(super) fn places(&self, triangle: u32) -> [Point; 3] {
        [0, 1, 2].map(|corner| self.place(self.corners[(3 * triangle + corner) as usize]))
    }

    /// Fills `changed` with the triangles that were made or changed since the last call, each once.
    pub(super) fn take_changed(&mut self, changed: &mut Vec<u32>) {
        changed.clear();
        changed.append(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
    }

    /// The triangle in which or on whose edge a point lies, sought from another triangle on.
    pub(super) fn locate(&self, point: Point, from: u32) -> u32 {
        let mut triangle = from;
        // Walks always towards the point, which in a Delaunay triangulation never cycles.
        while let Some(edge) = edges(triangle).find(|&edge| self.side(edge, point) < 0) {
            triangle = self.twins[edge as usize] / 3;
        }
        triangle
    }

    /// Adds a point that lies in `triangle` or on its edge and is none of its corners.
    pub(super) fn insert(&mut self, point: Point, triangle: u32) {
        let new = self.points.len() as u32;
        self.points.push(point);
        let on_edge = edges(triangle).find(|&edge| self.side(edge, point) == 0);
        match on_edge {
            Some(edge) => self.split_edge(edge, new),
            None => self.split_triangle(triangle, new),
        }
        while let Some(edge) = self.doubtful.pop() {
            self.legalise(edge);
        }
    }

    fn place(&self, point: u32) -> Point {
        self.points[point as usize]
    }

    fn start(&self, edge: u32) -> u32 {
        self.corners[edge as usize]
    }

    fn twin(&self, edge: u32) -> u32 {
        self.twins[edge as usize]
    }

    /// Above 0 to the left of the half-edge, 0 on its line.
    fn side(&self, edge: u32, point: Point) -> i64 {
        turn(self.place(self.start(edge)), self.place(self.start(next(edge))), point)
    }

    /// Sets a triangle whose first edge borders on `outer`, and doubts that edge.
    fn set(&mut self, triangle: u32, corners: [u32; 3], outer: u32) {
        let first = 3 * triangle;
        self.corners[first as usize..][..3].copy_from_slice(&corners);
        self.link(first, outer);
        self.changed.push(triangle);
        self.doubtful.push(first);
    }

    fn link(&mut self, edge: u32, twin: u32) {
        self.twins[edge as usize] = twin;
        if twin != OUTSIDE {
            self.twins[twin as usize] = edge;
        }
    }

    fn add_triangle(&mut self) -> u32 {
        let triangle = (self.corners.len() / 3) as u32;
        self.corners.extend([0; 3]);
        self.twins.extend([OUTSIDE; 3]);
        triangle
    }

    fn split_triangle(&mut self, triangle: u32, new: u32) {
        let edges = [0, 1, 2].map(|edge| 3 * triangle + edge);
        let [a, b, c] = edges.map(|edge| self.start(edge));
        let [ab, bc, ca] = edges.map(|edge| self.twin(edge));
        let (second, third) = (self.add_triangle(), self.add_triangle());
        self.set(triangle, [a, b, new], ab);
        self.set(second, [b, c, new], bc);
        self.set(third, [c, a, new], ca);
        self.link(3 * triangle + 1, 3 * second + 2);
        self.link(3 * second + 1, 3 * third + 2);
        self.link(3 * third + 1, 3 * triangle + 2);
    }

    fn split_edge(&mut self, edge: u32, new: u32) {
        let twin = self.twin(edge);
        let (near, near_half) = self.halve(edge, new);
        if twin == OUTSIDE {
            self.link(3 * near + 1, OUTSIDE);
            self.link(3 * near_half + 2, OUTSIDE);
            return;
        }
        let (far, far_half) = self.halve(twin, new);
        self.link(3 * near + 1, 3 * far_half + 2);
        self.link(3 * far + 1, 3 * near_half + 2);
    }

    /// Cuts the triangle of a half-edge `a b` from a point on it to the corner `c` across: into `c a new` and
    /// `b c new`.
    fn halve(&mut self, edge: u32, new: u32) -> (u32, u32) {
        let [a, b, c] = [edge, next(edge), previous(edge)].map(|edge| self.start(edge));
        let [bc, ca] = [next(edge), previous(edge)].map(|edge| self.twin(edge));
        let (first, second) = (edge / 3, self.add_triangle());
        self.set(first, [c, a, new], ca);
        self.set(second, [b, c, new], bc);
        self.link(3 * first + 2, 3 * second + 1);
        (first, second)
    }

    /// Flips an edge whose circle holds the corner across, and doubts the two edges behind it.
    fn legalise(&mut self, edge: u32) {
        let twin = self.twin(edge);
        if twin == OUTSIDE {
            return;
        }
        let [a, b, new] = [edge, next(edge), previous(edge)].map(|edge| self.start(edge));
        let across = self.start(previous(twin));
        if !self.is_illegal([a, b], new, across) {
            return;
        }
        let [b_new, new_a] = [next(edge), previous(edge)].map(|edge| self.twin(edge));
        let [a_across, across_b] = [next(twin), previous(twin)].map(|edge| self.twin(edge));
        let (first, second) = (edge / 3, twin / 3);
        self.set(first, [a, across, new], a_across);
        self.set(second, [across, b, new], across_b);
        self.link(3 * first + 1, 3 * second + 2);
        self.link(3 * first + 2, new_a);
        self.link(3 * second + 1, b_new);
    }

    fn is_illegal(&self, [a, b]: [u32; 2], new: u32, across: u32) -> bool {
        let circle = in_circle([a, b, new].map(|point| self.place(point)), self.place(across));
        let is_void = |point: u32| self.void.get(point as usize) == Some(&true);
        let is_tie_lost = || (is_void(a) || is_void(b)) && !is_void(new) && !is_void(across);
        circle > 0 || circle == 0 && is_tie_lost()
    }
}

fn edges(triangle: u32) -> std::ops::Range<u32> {
    3 * triangle..3 * triangle + 3
}

fn next(edge: u32) -> u32 {
    if edge % 3 == 2 { edge - 2 } else { edge + 1 }
}

fn previous(edge: u32) -> u32 {
    if edge.is_multiple_of(3) { edge + 2 } else { edge - 1 }
}

/// Twice the area of a triangle, above 0 where it runs anticlockwise on a map whose rows go south.
pub(super) fn turn(a: Point, b: Point, c: Point) -> i64 {
    let [ax, ay, bx, by, cx, cy] = [a[0], a[1], b[0], b[1], c[0], c[1]].map(i64::from);
    (by - ay) * (cx - ax) - (bx - ax) * (cy - ay)
}

/// Above 0 where `point` lies inside the circle of an anticlockwise triangle, 0 on it.
fn in_circle(triangle: [Point; 3], point: Point) -> i128 {
    let [a, b, c] = triangle.map(|corner| {
        let x = i128::from(corner[0]) - i128::from(point[0]);
        // Rows go south.
        let y = i128::from(point[1]) - i128::from(corner[1]);
        [x, y, x * x + y * y]
    });
    let minor = |p: [i128; 3], q: [i128; 3]| p[0] * q[1] - q[0] * p[1];
    a[2] * minor(b, c) + b[2] * minor(c, a) + c[2] * minor(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn with_points(columns: u32, rows: u32, points: &[Point]) -> Delaunay {
        let mut mesh = Delaunay::new(columns, rows, |_| false);
        for &point in points {
            let triangle = mesh.locate(point, 0);
            if !mesh.points.contains(&point) {
                mesh.insert(point, triangle);
            }
        }
        mesh
    }

    fn check_whole(mesh: &Delaunay, columns: u32, rows: u32) {
        let areas: Vec<_> = (0..mesh.triangles().count() as u32)
            .map(|triangle| mesh.places(triangle))
            .map(|[a, b, c]| turn(a, b, c))
            .collect();
        assert!(areas.iter().all(|&area| area > 0), "every triangle runs anticlockwise: {areas:?}");
        assert_eq!(areas.iter().sum::<i64>(), 2 * i64::from(columns - 1) * i64::from(rows - 1));
        for (edge, &twin) in (0..).zip(&mesh.twins) {
            let ends = [mesh.start(edge), mesh.start(next(edge))];
            if twin == OUTSIDE {
                let on_outline = |axis: usize, last: u32| {
                    let places = ends.map(|end| mesh.place(end)[axis]);
                    places[0] == places[1] && (places[0] == 0 || places[0] == last)
                };
                assert!(on_outline(0, columns - 1) || on_outline(1, rows - 1), "{ends:?} is on the outline");
            } else {
                assert_eq!(mesh.twin(twin), edge);
                assert_eq!([mesh.start(next(twin)), mesh.start(twin)], ends);
            }
        }
    }

    proptest! {
        #[test]
        fn the_triangles_fill_the_rectangle_and_no_circle_holds_a_point(
            columns in 2..40_u32, rows in 2..40_u32,
            shares in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 0..60),
        ) {
            let at = |share: f64, count: u32| (share * f64::from(count)) as u32;
            let points: Vec<_> = shares.iter().map(|&(x, y)| [at(x, columns), at(y, rows)]).collect();
            let mesh = with_points(columns, rows, &points);
            prop_assert!(points.iter().all(|point| mesh.points.contains(point)));
            check_whole(&mesh, columns, rows);
            for triangle in 0..mesh.triangles().count() as u32 {
                for &point in &mesh.points {
                    prop_assert!(in_circle(mesh.places(triangle), point) <= 0);
                }
            }
        }
    }

    #[test]
    fn a_corner_without_data_has_no_edge_where_another_will_do() {
        for void in [[0, 0], [3, 0], [0, 3], [3, 3]] {
            let mut mesh = Delaunay::new(4, 4, |point| point == void);
            let inwards = |at: u32| if at == 0 { 1 } else { at - 1 };
            let ring = [
                [inwards(void[0]), inwards(void[1])],
                [inwards(void[0]), void[1]],
                [void[0], inwards(void[1])],
            ];
            for point in ring {
                let triangle = mesh.locate(point, 0);
                mesh.insert(point, triangle);
            }
            let touching = (0..mesh.triangles().count() as u32)
                .filter(|&triangle| mesh.places(triangle).contains(&void));
            assert_eq!(touching.count(), 1, "{void:?} is cut off by one edge");
        }
    }
}
