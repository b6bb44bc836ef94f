//! Noise in space: gradient noise as `weald_core::grain` has it on a plane, with its exact slope.

use weald_core::grain::{bits, floor};

/// Noise in space and its slope along the three axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SolidGrain {
    /// About -0.7 to 0.7.
    pub(super) value: f32,
    /// Change by one wavelength.
    pub(super) slope: [f32; 3],
}

/// The gradient of a lattice point in space: any vector of a cube.
#[inline(always)]
fn solid_gradient([x, y, z]: [i32; 3], seed: u32) -> [f32; 3] {
    let hash = bits(x, y, seed ^ (z as u32).wrapping_mul(0x85eb_ca6b));
    [0, 8, 16].map(|shift| ((hash >> shift) & 0xff) as f32 * (1.0 / 127.5) - 1.0)
}

/// Noise in space at a place that is counted in wavelengths: a surface through it shows noise that is drawn out along none of
/// its slopes.
#[inline(always)]
pub(super) fn solid_grain(place: [f32; 3], seed: u32) -> SolidGrain {
    let corner = place.map(floor);
    let t: [f32; 3] = std::array::from_fn(|axis| place[axis] - corner[axis] as f32);
    let ease = t.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let ease_slope = t.map(|t| 30.0 * t * t * (t * (t - 2.0) + 1.0));
    let mut sum = SolidGrain::default();
    for at in 0..8 {
        let side = [at & 1, (at >> 1) & 1, at >> 2];
        let gradient = solid_gradient(std::array::from_fn(|axis| corner[axis] + side[axis]), seed);
        let near: [f32; 3] =
            std::array::from_fn(|axis| if side[axis] == 1 { ease[axis] } else { 1.0 - ease[axis] });
        let plane: f32 = (0..3).map(|axis| gradient[axis] * (t[axis] - side[axis] as f32)).sum();
        let weight = near[0] * near[1] * near[2];
        sum.value += weight * plane;
        for axis in 0..3 {
            let nearer = if side[axis] == 1 { ease_slope[axis] } else { -ease_slope[axis] };
            let others = near[(axis + 1) % 3] * near[(axis + 2) % 3];
            sum.slope[axis] += weight * gradient[axis] + nearer * others * plane;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_in_space_goes_on_over_its_lattice_and_has_the_slope_of_its_value() {
        let mut most = 0.0_f32;
        for step in 0..400 {
            let place = [0.377, -0.291, 0.173].map(|pace: f32| pace * step as f32);
            let here = solid_grain(place, 9);
            for axis in 0..3 {
                let moved = |by: f32| {
                    let place = std::array::from_fn(|at| place[at] + if at == axis { by } else { 0.0 });
                    solid_grain(place, 9).value
                };
                let rise = (moved(2e-3) - moved(-2e-3)) / 4e-3;
                assert!((here.slope[axis] - rise).abs() < 0.02, "{} for {rise}", here.slope[axis]);
            }
            most = most.max(here.value.abs());
        }
        assert!((0.4..1.0).contains(&most), "{most}");
        assert_eq!(solid_grain([3.0, -4.0, 5.0], 9).value, 0.0, "nothing on the lattice itself");
    }
}
