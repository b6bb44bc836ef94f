//! The normal map: what the full ground's normals are beside those of the simplified mesh.
//!
//! A renderer turns a texel `(x, y, z)` into the normal `x T + y B + z N` with the tangent `T` and the normal `N` that
//! it interpolates between the vertices, and `B = N × T` (Mikkelsen 2008, as in [`tangent`](super::tangent)). Here that
//! is solved for the texel, so that the lit mesh has the normals of all cells, whatever its triangles. Green is
//! towards the top of the texture, north.

use super::delaunay::Point;
use super::sampling::Sampling;
use super::slopes::normal;
use super::tin::Tin;
use super::vector::{Vector, cross, dot, unit};
use super::vertices::Vertices;
use weald_core::grid::Size;

/// Rings of texels beyond the mesh that take the colour of their neighbours, so that the coarser texels of
/// mip maps have no seam.
const MARGIN: usize = 8;

/// A texel of a surface that is as its vertices say.
const FLAT: [u8; 3] = [128, 128, 255];

/// Red, green and blue of each texel, row-major from the north-west.
pub(super) fn normal_map(mesh: &Tin, vertices: &Vertices, sampling: &Sampling<'_>) -> Vec<u8> {
    let mut map = Map { size: sampling.texels, texels: vec![None; sampling.texels.cells()] };
    for (triangle, corners) in mesh.triangles.iter().zip(mesh.places()) {
        let frames = triangle.map(|vertex| {
            let vertex = vertex as usize;
            (vertices.normals[vertex], vertices.tangents[vertex])
        });
        for_each_texel(sampling, corners, |[x, y], shares| {
            let [east, south] = sampling.slopes(x, y);
            let normal_of =
                |part: fn(&(Vector, Vector)) -> Vector| blend(frames.each_ref().map(part), shares);
            let texel = texel(normal(east, south), normal_of(|frame| frame.0), normal_of(|frame| frame.1));
            map.texels[sampling.texels.index(x, y)] = Some(texel);
        });
    }
    map.grow();
    map.texels.into_iter().flat_map(|texel| texel.unwrap_or(FLAT)).collect()
}

fn blend(vectors: [Vector; 3], shares: [f64; 3]) -> Vector {
    std::array::from_fn(|axis| (0..3).map(|corner| vectors[corner][axis] * shares[corner]).sum())
}

/// The texel that turns an interpolated normal and tangent into `wanted`.
fn texel(wanted: Vector, normal: Vector, tangent: Vector) -> [u8; 3] {
    let across = cross(normal, tangent);
    // `across` stands on both others, which are not quite at right angles to each other.
    let (nn, nt, tt) = (dot(normal, normal), dot(normal, tangent), dot(tangent, tangent));
    let (wn, wt) = (dot(wanted, normal), dot(wanted, tangent));
    let area = nn * tt - nt * nt;
    let solved = unit([
        (wt * nn - wn * nt) / area,
        dot(wanted, across) / dot(across, across),
        ((wn * tt - wt * nt) / area).max(0.0),
    ]);
    solved.map(|number| libm::round((number + 1.0) * 127.5).clamp(0.0, 255.0) as u8)
}

/// Calls `visit` with each texel whose centre lies in a triangle, and the shares of the three corners in it.
fn for_each_texel(sampling: &Sampling<'_>, corners: [Point; 3], mut visit: impl FnMut([usize; 2], [f64; 3])) {
    let [a, b, c] = corners.map(|corner| sampling.texel_of(corner));
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let range = |axis: usize, count: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]).ceil().max(0.0) as usize;
        let high = a[axis].max(b[axis]).max(c[axis]).floor() as usize;
        low..(high + 1).min(count)
    };
    for y in range(1, sampling.texels.rows) {
        for x in range(0, sampling.texels.columns) {
            let (dx, dy) = (x as f64 - a[0], y as f64 - a[1]);
            let second = (dx * (c[1] - a[1]) - (c[0] - a[0]) * dy) / area;
            let third = ((b[0] - a[0]) * dy - dx * (b[1] - a[1])) / area;
            let shares = [1.0 - second - third, second, third];
            if shares.iter().all(|&share| share >= -ROUNDING) {
                visit([x, y], shares);
            }
        }
    }
}

/// Share of a triangle by which a texel on its edge may lie outside by rounding.
const ROUNDING: f64 = 1e-9;

struct Map {
    size: Size,
    texels: Vec<Option<[u8; 3]>>,
}

impl Map {
    /// Texels beyond the mesh take the mean of their neighbours, ring after ring.
    fn grow(&mut self) {
        let mut ring: Vec<_> = (0..self.texels.len()).filter(|&at| self.is_next(at)).collect();
        for _ in 0..MARGIN {
            let means: Vec<_> = ring.iter().map(|&at| self.mean(at)).collect();
            for (&at, mean) in ring.iter().zip(means) {
                self.texels[at] = Some(mean);
            }
            let beyond = ring.iter().flat_map(|&at| self.size.neighbours(at));
            ring = beyond.filter(|&at| self.texels[at].is_none()).collect();
            ring.sort_unstable();
            ring.dedup();
        }
    }

    fn is_next(&self, at: usize) -> bool {
        self.texels[at].is_none() && self.size.neighbours(at).any(|other| self.texels[other].is_some())
    }

    fn mean(&self, at: usize) -> [u8; 3] {
        let known: Vec<_> = self.size.neighbours(at).filter_map(|other| self.texels[other]).collect();
        let mean = |channel: usize| {
            let sum: usize = known.iter().map(|texel| usize::from(texel[channel])).sum();
            (sum / known.len().max(1)) as u8
        };
        [0, 1, 2].map(mean)
    }
}
