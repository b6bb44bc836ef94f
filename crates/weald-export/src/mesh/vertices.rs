//! What a mesh says of each vertex.

use super::frame::Frame;
use super::slopes::Slopes;
use super::tangent::tangents;
use super::tin::Tin;
use super::vector::Vector;
use weald_core::grid::Field;

/// Attributes, one of each a vertex.
#[derive(Debug)]
pub(super) struct Vertices {
    /// Metres east, up and south of the middle of the domain.
    pub(super) positions: Vec<Vector>,
    /// Unit normals of the ground at full resolution.
    pub(super) normals: Vec<Vector>,
    /// Unit tangents.
    pub(super) tangents: Vec<Vector>,
    /// Places in the textures.
    pub(super) textures: Vec<[f32; 2]>,
}

impl Vertices {
    /// Attributes of a mesh over heights.
    pub(super) fn of(mesh: &Tin, height: &Field, slopes: &Slopes, frame: &Frame) -> Self {
        let place = |&point: &[u32; 2]| frame.place(point, height.at(point[0] as usize, point[1] as usize));
        let positions: Vec<_> = mesh.points.iter().map(place).collect();
        let normals: Vec<_> = mesh.points.iter().map(|&point| slopes.normal(point)).collect();
        let tangents = tangents(&positions, &normals, &mesh.triangles);
        let textures = mesh.points.iter().map(|&point| frame.texture(point)).collect();
        Self { positions, normals, tangents, textures }
    }
}

/// Numbers as a file holds them.
pub(super) fn single(vectors: &[Vector]) -> Vec<[f32; 3]> {
    vectors.iter().map(|vector| vector.map(|number| number as f32)).collect()
}

/// Tangents as a file holds them: the last number says that the texture is not mirrored.
pub(super) fn signed(tangents: &[Vector]) -> Vec<[f32; 4]> {
    let signed = |&[x, y, z]: &Vector| [x as f32, y as f32, z as f32, 1.0];
    tangents.iter().map(signed).collect()
}
