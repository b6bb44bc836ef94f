//! A finished mesh over the grid: a triangulated irregular network.

use super::delaunay::{Delaunay, Point};
use super::plane::Plane;
use super::scan::for_each_row;
use super::surface::Surface;

/// Vertices at centres of cells and triangles that run anticlockwise as seen on a map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Tin {
    /// Column and row of each vertex.
    pub(super) points: Vec<Point>,
    /// Vertices of each triangle.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Stands for a vertex that no triangle has used yet.
const UNUSED: u32 = u32::MAX;

impl Tin {
    /// The triangles on ground, near ones one after the other, with the vertices that they use.
    pub(super) fn of(mesh: &Delaunay, surface: &Surface<'_>) -> Self {
        let place = |point: u32| mesh.points()[point as usize];
        let on_ground = |triangle: &[u32; 3]| surface.is_ground(triangle.map(place));
        let mut triangles: Vec<_> = mesh.triangles().filter(on_ground).collect();
        triangles.sort_unstable_by_key(|&triangle| (curve(triangle.map(place)), triangle));
        let mut numbers = vec![UNUSED; mesh.points().len()];
        let mut points = Vec::new();
        let mut number = |point: u32| {
            let number = &mut numbers[point as usize];
            if *number == UNUSED {
                *number = points.len() as u32;
                points.push(place(point));
            }
            *number
        };
        let triangles = triangles.into_iter().map(|triangle| triangle.map(&mut number)).collect();
        Self { points, triangles }
    }

    /// Where the corners of each triangle lie.
    pub(super) fn places(&self) -> impl Iterator<Item = [Point; 3]> {
        self.triangles.iter().map(|triangle| triangle.map(|point| self.points[point as usize]))
    }

    /// The greatest deviation from the surface at any cell that a triangle covers, in metres.
    pub(super) fn deviation(&self, surface: &Surface<'_>) -> f64 {
        let mut greatest = 0.0_f64;
        for triangle in self.places() {
            let plane = Plane::through(triangle.map(|corner| (corner, surface.at(corner))));
            for_each_row(triangle, |row, columns| {
                for column in columns {
                    let height = f64::from(surface.height.at(column, row));
                    greatest = greatest.max((plane.at(column, row) - height).abs());
                }
            });
        }
        greatest
    }

    /// Edges that bound one triangle alone, each in the direction of its triangle, in rising order.
    pub(super) fn outline(&self) -> Vec<[u32; 2]> {
        let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
        let mut sides: Vec<_> = self.triangles.iter().flat_map(sides).collect();
        let ends = |&[a, b]: &[u32; 2]| [a.min(b), a.max(b)];
        sides.sort_unstable_by_key(ends);
        let shared = sides.chunk_by(|first, second| ends(first) == ends(second));
        shared.filter(|sides| sides.len() == 1).map(|sides| sides[0]).collect()
    }
}

/// Position of a triangle's centroid along a Z-order curve.
fn curve(triangle: [Point; 3]) -> u64 {
    let [x, y] = [0, 1].map(|axis| triangle.iter().map(|corner| corner[axis]).sum::<u32>());
    spread(x) | spread(y) << 1
}

/// The bits of a number, a zero before each.
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    for (shift, mask) in [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555_u64),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}
