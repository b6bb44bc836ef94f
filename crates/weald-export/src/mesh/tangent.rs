//! Tangents of a mesh's texture, the same that readers make for themselves.
//!
//! Of each triangle at a vertex, the direction in which the texture runs eastward is laid into the plane across the
//! vertex's normal; the tangent is their mean, weighted by the triangles' angles in that plane. Morten S. Mikkelsen,
//! "Simulation of wrinkled surfaces revisited", University of Copenhagen (2008), as in his program `mikktspace.c`
//! (2011), which normal maps are by convention made for. What differs: no triangle here is mirrored or degenerate, and
//! triangles that meet in nothing but a vertex are not told apart.

use super::vector::{Vector, add_scaled, cross, dot, unit};

/// Square of a sum of directions that cancel each other, as on two walls that face each other.
const MIN_SQUARE: f64 = 1e-12;

/// A tangent for each vertex, of length 1 and across its normal.
///
/// The texture's u runs along the first axis and its v along the third.
pub(super) fn tangents(positions: &[Vector], normals: &[Vector], triangles: &[[u32; 3]]) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for triangle in triangles {
        let corners = triangle.map(|vertex| positions[vertex as usize]);
        let eastward = eastward(corners);
        for (corner, &vertex) in triangle.iter().enumerate() {
            let normal = normals[vertex as usize];
            let towards = |other: usize| add_scaled(corners[other % 3], corners[corner], -1.0);
            let angle = angle(normal, towards(corner + 1), towards(corner + 2));
            let sum = &mut sums[vertex as usize];
            *sum = add_scaled(*sum, laid(eastward, normal), angle);
        }
    }
    let finished =
        |(sum, &normal)| if dot(sum, sum) > MIN_SQUARE { unit(sum) } else { laid([1.0, 0.0, 0.0], normal) };
    sums.into_iter().zip(normals).map(finished).collect()
}

/// The direction in the plane of a triangle that looks eastward from above.
fn eastward([a, b, c]: [Vector; 3]) -> Vector {
    let [x, y, _] = cross(add_scaled(b, a, -1.0), add_scaled(c, a, -1.0));
    unit([y, -x, 0.0])
}

/// A direction laid into the plane across a normal.
fn laid(direction: Vector, normal: Vector) -> Vector {
    unit(add_scaled(direction, normal, -dot(normal, direction)))
}

fn angle(normal: Vector, first: Vector, second: Vector) -> f64 {
    let cosine = dot(laid(first, normal), laid(second, normal));
    libm::acos(cosine.clamp(-1.0, 1.0))
}
