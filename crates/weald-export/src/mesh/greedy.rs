//! As few triangles as follow the ground to a stated error: greedy insertion.
//!
//! The mesh starts as two triangles. The cell that deviates most from it becomes a vertex, the mesh is made Delaunay
//! again, and so on until no cell deviates by more than it bears. Michael Garland and Paul S. Heckbert, "Fast polygonal
//! approximation of terrains and height fields", Carnegie Mellon University CMU-CS-95-181 (1995), algorithm III: each
//! triangle keeps its own worst cell, so an insertion looks only at the cells of triangles that it changed.
//!
//! What differs: deviations are counted in what each cell bears. And land may end at cells without data. All land
//! cells beside such a cell are vertices from the start; a step along their line, straight or diagonal, has a circle
//! with no other vertex in it, so the line stands in every Delaunay triangulation and no triangle crosses it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::delaunay::{Delaunay, Point};
use super::plane::Plane;
use super::scan::for_each_row;
use super::surface::Surface;
use super::tin::Tin;
use weald_core::error::{Error, Limit, Quantity};

/// The cell of a triangle that deviates most, in what cells bear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Worst {
    deviation: f32,
    point: Point,
}

/// A mesh of at most `most` vertices that follows the surface, which is at least two cells wide and deep.
///
/// # Errors
/// [`Error::Limit`] where more vertices are needed.
pub(super) fn follow(surface: &Surface<'_>, most: usize) -> Result<Tin, Error> {
    let mut refinement = Refinement::of(surface);
    refinement.trace_shores();
    refinement.look_at_changes();
    while let Some((triangle, point)) = refinement.next() {
        if refinement.mesh.points().len() >= most {
            let subject = format!("a mesh of {} cells that is true to the error asked for", surface.size());
            let limit = Limit::new(Quantity::Vertices, None, 0..=most as u64);
            return Err(limit.of(subject).remedy("choose a larger `error`").into());
        }
        refinement.mesh.insert(point, triangle);
        refinement.look_at_changes();
    }
    Ok(Tin::of(&refinement.mesh, surface))
}

struct Refinement<'a> {
    surface: &'a Surface<'a>,
    mesh: Delaunay,
    /// By triangle.
    worst: Vec<Worst>,
    /// Triangles by the bits of their worst deviation, which sort as the number does; outdated ones among them.
    queue: BinaryHeap<(u32, Reverse<u32>, Point)>,
    changed: Vec<u32>,
}

impl<'a> Refinement<'a> {
    fn of(surface: &'a Surface<'a>) -> Self {
        let size = surface.size();
        let mesh = Delaunay::new(size.columns as u32, size.rows as u32, |point| !surface.is_valid(point));
        Self { surface, mesh, worst: Vec::new(), queue: BinaryHeap::new(), changed: Vec::new() }
    }

    /// Makes every land cell beside a cell without data a vertex.
    fn trace_shores(&mut self) {
        let Some(valid) = self.surface.valid else { return };
        let size = valid.size();
        let corners = self.mesh.points().to_vec();
        let mut triangle = 0;
        for cell in (0..size.cells()).filter(|&cell| valid.is_valid_at(cell)) {
            let point = [(cell % size.columns) as u32, (cell / size.columns) as u32];
            let is_shore = size.neighbours(cell).any(|other| !valid.is_valid_at(other));
            if is_shore && !corners.contains(&point) {
                triangle = self.mesh.locate(point, triangle);
                self.mesh.insert(point, triangle);
            }
        }
    }

    fn look_at_changes(&mut self) {
        let mut changed = std::mem::take(&mut self.changed);
        self.mesh.take_changed(&mut changed);
        for &triangle in &changed {
            let worst = worst(self.surface, self.mesh.places(triangle));
            let place = triangle as usize;
            self.worst.resize(self.worst.len().max(place + 1), Worst::default());
            self.worst[place] = worst;
            if worst.deviation > 1.0 {
                self.queue.push((worst.deviation.to_bits(), Reverse(triangle), worst.point));
            }
        }
        self.changed = changed;
    }

    /// The triangle with the worst cell of all, and that cell.
    fn next(&mut self) -> Option<(u32, Point)> {
        loop {
            let (deviation, Reverse(triangle), point) = self.queue.pop()?;
            let queued = Worst { deviation: f32::from_bits(deviation), point };
            if self.worst[triangle as usize] == queued {
                return Some((triangle, point));
            }
        }
    }
}

fn worst(surface: &Surface<'_>, triangle: [Point; 3]) -> Worst {
    let plane = Plane::through(triangle.map(|corner| (corner, surface.at(corner))));
    let mut worst = Worst::default();
    for_each_row(triangle, |row, columns| {
        let first = *columns.start();
        let cells =
            surface.height.row(row)[columns.clone()].iter().zip(&surface.strictness.row(row)[columns]);
        for (column, (&height, &strictness)) in (first..).zip(cells) {
            let deviation = (plane.at(column, row) - f64::from(height)).abs() as f32 * strictness;
            if deviation > worst.deviation {
                worst = Worst { deviation, point: [column as u32, row as u32] };
            }
        }
    });
    worst
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Mask, Size};

    fn follow_all(height: &Field, valid: Option<&Mask>, error: f64) -> Tin {
        follow(&Surface::new(height, valid, error), 1 << 20).expect("few vertices")
    }

    #[test]
    fn a_plane_is_two_triangles_whatever_the_error() {
        let size = Size::new(300, 70).expect("legal");
        let height = Field::from_function(size, |x, y| 0.37 * x as f32 - 1.91 * y as f32 + 800.0);
        let mesh = follow_all(&height, None, 0.001);
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (4, 2));
    }

    #[test]
    fn one_peak_on_a_plain_takes_the_vertices_of_its_foot_alone() {
        let size = Size::square(65).expect("legal");
        let mut height = Field::filled(size, 10.0);
        height.set(20, 33, 25.0);
        let mesh = follow_all(&height, None, 0.5);
        assert!(mesh.points.contains(&[20, 33]));
        assert!((9..=25).contains(&mesh.points.len()), "{} vertices", mesh.points.len());
    }

    #[test]
    fn what_deviates_by_less_than_the_error_is_left_out() {
        let size = Size::square(65).expect("legal");
        let mut height = Field::filled(size, 10.0);
        height.set(20, 33, 10.9);
        assert_eq!(follow_all(&height, None, 1.0).triangles.len(), 2);
        assert!(follow_all(&height, None, 0.8).triangles.len() > 2);
    }

    #[test]
    fn a_mesh_of_too_many_vertices_is_refused() {
        let size = Size::square(64).expect("legal");
        let height = Field::from_function(size, |x, y| ((x * 31 + y * 17) % 23) as f32);
        let error = follow(&Surface::new(&height, None, 0.1), 100).expect_err("rough ground");
        assert_eq!(error.exit_code(), 5);
        let message = error.to_string();
        assert!(
            message.contains("more than the 100 vertices that are allowed; choose a larger"),
            "{message}"
        );
    }
}
