//! Heights of a mesh between its vertices: what is to stand on it stands there, and not on the ground that it left out.

use super::delaunay::Point;
use super::plane::Plane;
use super::water::Water;
use super::{MAX_VERTICES, Mesh, follow, ground_of};
use weald_core::error::Error;
use weald_core::landscape::Landscape;

impl Mesh {
    /// The height of the mesh at each place, given in metres east and south of the north-western corner; `None` where
    /// it has no triangle.
    ///
    /// # Errors
    /// Those of the mesh.
    pub(crate) fn heights(
        &self,
        landscape: &Landscape,
        places: &[[f64; 2]],
    ) -> Result<Vec<Option<f64>>, Error> {
        let (ground, size) = (ground_of(landscape, &self.of.0)?, landscape.domain.size);
        let water = self.water.then(|| Water::of(landscape, ground, self.shallowest as f32)).flatten();
        let surface = self.surface(landscape, ground, water.as_ref());
        let mesh = follow(&surface, MAX_VERTICES)?;
        let steps: Vec<_> =
            places.iter().map(|place| place.map(|along| along / landscape.domain.cell - 0.5)).collect();
        let mut in_square = vec![Vec::new(); size.cells()];
        for (number, step) in steps.iter().enumerate() {
            let [x, y] = step.map(|along| along.max(0.0) as usize);
            in_square[size.index(x.min(size.columns - 1), y.min(size.rows - 1))].push(number);
        }
        let mut heights = vec![None; places.len()];
        for corners in mesh.places() {
            let plane = Plane::through(corners.map(|corner| (corner, surface.at(corner))));
            for square in squares(corners) {
                for &number in &in_square[size.index(square[0], square[1])] {
                    if is_inside(corners, steps[number]) {
                        heights[number] = Some(plane.between(steps[number]));
                    }
                }
            }
        }
        Ok(heights)
    }
}

/// The squares between centres that a triangle may touch.
fn squares(corners: [Point; 3]) -> impl Iterator<Item = [usize; 2]> {
    let span = |axis: usize| {
        let along = corners.map(|corner| corner[axis] as usize);
        along.into_iter().min().unwrap_or(0)..=along.into_iter().max().unwrap_or(0)
    };
    let columns = span(0);
    span(1).flat_map(move |y| columns.clone().map(move |x| [x, y]))
}

/// Whether a place is in a triangle or on its edge, whichever way its corners run.
fn is_inside(corners: [Point; 3], [x, y]: [f64; 2]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let side = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}
