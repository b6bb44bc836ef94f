//! Blades of grass on a device: vertices of instances, to be compared with those of the CPU.

use weald::Error;
use weald::grow::grass::device::GROW;
use weald::grow::grass::{Grasses, Packed, Vertex};

use super::pass::{self, Pass, Work};
use super::points::{BYTES, Points};
use crate::gpu::Gpu;

/// The vertices that the shader of grass makes of instances, one for each: that of the corner of the same number, which is
/// twice the number of a blade and one more on its right side, how far along it, and the push of the wind.
///
/// # Errors
/// [`Error::Device`] where the device's memory does not hold them, or it fails.
///
/// # Panics
/// If there are not as many corners as instances: a bug of the caller.
pub fn grow_blades(
    gpu: &Gpu,
    grasses: &Grasses,
    sets: &[Packed],
    corners: &[[f32; 4]],
) -> Result<Vec<Vertex>, Error> {
    assert_eq!(sets.len(), corners.len(), "a corner for each instance");
    let given = Points::new(gpu, sets.len() as u64, true, 4 * BYTES)?;
    given.write(sets, |piece| &piece.rests)?;
    given.write(corners, |piece| &piece.codes)?;
    let mut grown = Points::new(gpu, given.len(), true, 2 * BYTES)?;
    let pass = Pass::new(gpu, &GROW)?;
    let species = pass::uniform(gpu, "the species of grass", grasses)?;
    let Points { pace, pieces, .. } = &mut grown;
    for (from, into) in given.pieces.iter().zip(pieces.iter()) {
        let bound = pass.bind(gpu, &[&species], &[&from.rests, &from.codes, &into.rests, &into.codes])?;
        let (points, of_a_group) = (into.count, GROW.group);
        pass.run(gpu, pace, Work { bound: &bound, points, of_a_group, bytes: 4 * BYTES, given: None })?;
    }
    let places = grown.read(|_, piece| &piece.rests)?;
    let normals = grown.read(|_, piece| &piece.codes)?;
    let vertices = places.into_iter().zip(normals).zip(corners);
    Ok(vertices.map(|((place, normal), corner)| Vertex::of_a_device(place, normal, corner[1])).collect())
}
