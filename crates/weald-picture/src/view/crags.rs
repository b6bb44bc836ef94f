//! Ridges and gullies that are finer than cells: noise in space, of which the ground is a slice, so that none is drawn out
//! down slopes or along cliffs.
//!
//! Noise that is folded at 0 has sharp crests: the ridged noise of Musgrave (Ebert and others 2003, "Texturing and Modeling",
//! chapter 16), summed up in octaves that fade before they could flicker.

use super::solid_grain::solid_grain;
use weald_core::grain::visible;
use weald_core::vectors;

/// The longest wavelength in cells, the number of octaves, and what each is against the one before, which is twice as long.
const CELLS: f32 = 4.0;
const OCTAVES: u32 = 5;
const GAIN: f32 = 0.65;

/// What makes them another than other noise.
const SEED: u32 = 0x13;

/// How round crests are: the square of the value below which noise is not folded.
const SHARP: f32 = 0.0015;

/// The mean of folded noise.
const MEAN: f32 = 0.18;

/// Ridges and gullies at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Crags {
    /// Height over the side of a cell, from about -0.6 in gullies to 0.4 on ridges.
    pub(super) height: f32,
    /// Rise over run, eastward and northward.
    pub(super) slope: [f32; 2],
}

/// Ridges and gullies on ground that rises so eastward and northward, for a pixel of that footprint; lengths in metres.
pub(super) fn crags(point: [f32; 3], rise: [f32; 2], cell: f32, footprint: f32) -> Crags {
    let mut sum = Crags::default();
    let (mut strength, mut wavelength) = (1.0, CELLS * cell);
    // Each octave is turned by the angle of the 3-4-5 triangle, so that lattices do not align.
    let (mut place, mut turn) = (point, [1.0_f32, 0.0]);
    for octave in 0..OCTAVES {
        let seen = strength * visible(footprint, wavelength);
        if seen <= 0.0 {
            break;
        }
        let here = solid_grain(
            place.map(|metres| metres / wavelength),
            SEED.wrapping_add(octave.wrapping_mul(0x9e37_79b9)),
        );
        let sharp = (here.value * here.value + SHARP).sqrt();
        let [a, b, upward] = here.slope.map(|slope| -seen * here.value * cell / (sharp * wavelength) * slope);
        sum.height += seen * (MEAN - sharp);
        // Along the ground one comes to other heights.
        sum.slope[0] += turn[0] * a - turn[1] * b + upward * rise[0];
        sum.slope[1] += turn[1] * a + turn[0] * b + upward * rise[1];
        place = [0.8 * place[0] + 0.6 * place[1], 0.8 * place[1] - 0.6 * place[0], place[2]];
        turn = [0.8 * turn[0] - 0.6 * turn[1], 0.8 * turn[1] + 0.6 * turn[0]];
        strength *= GAIN;
        wavelength *= 0.5;
    }
    sum
}

/// The heights of crags at many points, for pixels of one footprint, as [`crags`] has them; the points are used up.
pub(super) fn heights([east, north, up]: [&mut [f32]; 3], cell: f32, footprint: f32) -> Vec<f32> {
    let mut sums = vec![0.0; east.len()];
    let (mut strength, mut wavelength) = (1.0, CELLS * cell);
    for octave in 0..OCTAVES {
        let seen = strength * visible(footprint, wavelength);
        if seen <= 0.0 {
            break;
        }
        let seed = SEED.wrapping_add(octave.wrapping_mul(0x9e37_79b9));
        vectors::widest(
            #[inline(always)]
            || {
                for (((sum, x), y), z) in sums.iter_mut().zip(&mut *east).zip(&mut *north).zip(&*up) {
                    let value = solid_grain([*x / wavelength, *y / wavelength, *z / wavelength], seed).value;
                    *sum += seen * (MEAN - (value * value + SHARP).sqrt());
                    [*x, *y] = [0.8 * *x + 0.6 * *y, 0.8 * *y - 0.6 * *x];
                }
            },
        );
        strength *= GAIN;
        wavelength *= 0.5;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The deviation of the change of height over a metre along a direction, on a face that rises eastward.
    fn change(rise: f32, [x, y, z]: [f32; 3]) -> f32 {
        let at = |point: [f32; 3]| crags(point, [rise, 0.0], 10.0, 0.1).height;
        let squares = (0..2000).map(|step| {
            let start = [step as f32 * 13.7, step as f32 * -7.9, step as f32 * 3.3];
            (at([start[0] + x, start[1] + y, start[2] + z]) - at(start)).powi(2)
        });
        (squares.sum::<f32>() / 2000.0).sqrt()
    }

    #[test]
    fn on_a_cliff_they_are_not_drawn_out_downward() {
        let along = change(4.0, [0.0, 1.0, 0.0]);
        let length = (1.0_f32 + 16.0).sqrt();
        let down = change(4.0, [-1.0 / length, 0.0, -4.0 / length]);
        assert!((0.8..1.25).contains(&(down / along)), "{down} downward, {along} along");
    }

    #[test]
    fn slopes_are_those_of_the_height_on_level_ground() {
        for step in 0..200 {
            let point = [step as f32 * 17.3, step as f32 * -9.1, 0.0];
            let at = |east: f32, north: f32| {
                10.0 * crags([point[0] + east, point[1] + north, 0.0], [0.0; 2], 10.0, 0.0).height
            };
            let measured = [at(0.01, 0.0) - at(-0.01, 0.0), at(0.0, 0.01) - at(0.0, -0.01)];
            for (slope, rise) in crags(point, [0.0; 2], 10.0, 0.0).slope.iter().zip(measured) {
                assert!((slope - rise / 0.02).abs() < 0.05, "{slope} for {}", rise / 0.02);
            }
        }
    }

    #[test]
    fn many_points_have_the_bits_of_each() {
        let points: Vec<[f32; 3]> =
            (0..77).map(|i| [3.7, -1.9, 0.8].map(|pace: f32| pace * i as f32)).collect();
        for footprint in [0.0, 3.0, 60.0] {
            let mut axes = [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<_>>());
            let [east, north, up] = &mut axes;
            for (height, point) in heights([east, north, up], 10.0, footprint).into_iter().zip(&points) {
                assert_eq!(height, crags(*point, [0.4, 0.2], 10.0, footprint).height);
            }
        }
    }

    #[test]
    fn none_is_seen_from_afar() {
        assert_eq!(crags([3.0, 4.0, 5.0], [0.5, 0.2], 10.0, 60.0), Crags::default());
    }
}
