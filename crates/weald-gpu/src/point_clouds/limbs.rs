//! Limbs of plants on a device: where points of them go in the wind, to be compared with those of the CPU.

use weald::Error;
use weald::grow::ifs::limbs::{BEND, Limb};

use super::pass::{self, Pass, Work};
use super::points::{BYTES, Points};
use crate::gpu::Gpu;

/// Where a point goes, and the push of the wind there, east and north.
pub type Swayed = ([f32; 3], [f32; 2]);

/// Where the shader of limbs puts points, one for each of the `rests`, a point and how far along its limb it lies, by the one
/// of the `winds` of the same number: a place east and north, a moment, and the number of its limb. Beside each point stands
/// the push of the wind there.
///
/// # Errors
/// [`Error::Device`] where the device's memory does not hold them, or it fails.
///
/// # Panics
/// If there are not as many winds as rests: a bug of the caller.
pub fn bend_limbs(
    gpu: &Gpu,
    limbs: &[Limb],
    rests: &[[f32; 4]],
    winds: &[[f32; 4]],
) -> Result<Vec<Swayed>, Error> {
    assert_eq!(rests.len(), winds.len(), "a wind for each point");
    let given = Points::new(gpu, rests.len() as u64, true, 4 * BYTES)?;
    given.write(rests, |piece| &piece.rests)?;
    given.write(winds, |piece| &piece.codes)?;
    let mut bent = Points::new(gpu, given.len(), true, 2 * BYTES)?;
    let pass = Pass::new(gpu, &BEND)?;
    let packed: Vec<_> = limbs.iter().map(Limb::packed).collect();
    let limbs = pass::table(gpu, "limbs", &packed)?;
    let Points { pace, pieces, .. } = &mut bent;
    for (from, into) in given.pieces.iter().zip(pieces.iter()) {
        let buffers = [&limbs, &from.rests, &from.codes, &into.rests, &into.codes];
        let bound = pass.bind(gpu, &[], &buffers)?;
        let (points, of_a_group) = (into.count, BEND.group);
        pass.run(gpu, pace, Work { bound: &bound, points, of_a_group, bytes: 4 * BYTES, given: None })?;
    }
    let places = bent.read(|_, piece| &piece.rests)?;
    let pushes = bent.read(|_, piece| &piece.codes)?;
    Ok(places
        .into_iter()
        .zip(pushes)
        .map(|([x, y, z, _], [east, north, ..])| ([x, y, z], [east, north]))
        .collect())
}
