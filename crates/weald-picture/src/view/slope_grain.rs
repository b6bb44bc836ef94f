//! Noise on ground that may be steep: taken on the planes that the ground faces, so that it is drawn out down no slope.
//!
//! The level plane alone counts up to a slope of about 35°, an upright one where the ground stands; between them noises of two or
//! three planes are added by weights whose squares sum to one, so that the sum varies as much as each of them. With the fourth
//! powers of a normal's parts as weights, less a share of the greatest, most places are on one plane.

use super::vector::Vector;
use super::woods::turned;
use weald_core::grain::{Grain, Octaves, visible};

/// Share of the greatest weight up to which another counts for nothing.
const ONE_PLANE: f32 = 0.25;

/// Weights of the planes that are upright and face east or west, upright and face north or south, and level, on ground that
/// rises so eastward and northward.
fn planes(rise: [f32; 2]) -> Vector {
    let fourth = |part: f32| part * part * part * part;
    let facing = [fourth(rise[0]), fourth(rise[1]), 1.0];
    let most = facing[0].max(facing[1]).max(1.0);
    let held = facing.map(|facing| (facing / most - ONE_PLANE).max(0.0));
    let length = held.iter().map(|held| held * held).sum::<f32>().sqrt();
    held.map(|held| held / length)
}

/// Noise at a place of an upright plane, along it and up, and its slope along both.
pub(super) fn on_upright(octaves: Octaves, place: [f32; 2], footprint: f32) -> Grain {
    // On lattices that stand upright it would be drawn in bars.
    let [a, b] = turned(place);
    let Grain { value, slope: [first, second] } = octaves.at([a, b, 0.0], footprint);
    Grain { value, slope: [0.8 * first - 0.6 * second, 0.6 * first + 0.8 * second] }
}

/// Noise at a point of ground that rises so, for a pixel of that footprint in metres; its slope is that of what lies on the
/// ground, eastward and northward.
pub(super) fn on_slope(octaves: Octaves, point: Vector, rise: [f32; 2], footprint: f32) -> Grain {
    let mut sum = Grain::default();
    if visible(footprint, octaves.wavelength) <= 0.0 {
        return sum;
    }
    let [x, y, z] = point;
    let [facing_east, facing_north, level] = planes(rise);
    if level > 0.0 {
        let here = octaves.at(point, footprint);
        sum = Grain { value: level * here.value, slope: here.slope.map(|slope| level * slope) };
    }
    for (axis, weight, along) in [(1, facing_east, y), (0, facing_north, x)] {
        if weight > 0.0 {
            let Grain { value, slope: [level, up] } = on_upright(octaves, [along, z], footprint);
            sum.value += weight * value;
            sum.slope[axis] += weight * level;
            sum.slope = [0, 1].map(|axis| sum.slope[axis] + weight * up * rise[axis]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const OCTAVES: Octaves = Octaves { wavelength: 0.24, count: 4, gain: 0.7, seed: 5 };

    /// The point of a slope that many metres along it and up it, and its noise.
    fn at(rise: [f32; 2], along: f32, up: f32) -> Grain {
        let steep = rise[0].hypot(rise[1]);
        let [east, north] = if steep > 0.0 { rise.map(|part| part / steep) } else { [1.0, 0.0] };
        let run = up / (1.0 + steep * steep).sqrt();
        let point = [run * east - along * north, run * north + along * east, run * steep];
        on_slope(OCTAVES, point, rise, 0.001)
    }

    #[test]
    fn nothing_is_drawn_out_down_a_slope() {
        for rise in [[0.0, 0.0], [0.5, 0.2], [0.9, 0.3], [1.5, -1.0], [-4.0, 2.0], [0.0, 9.0]] {
            let change = |step: [f32; 2]| {
                let leap = |number: u16| {
                    let [a, b] = [0.37, 0.91].map(|pace: f32| pace * f32::from(number));
                    (at(rise, a + step[0], b + step[1]).value - at(rise, a, b).value).abs()
                };
                (0..4000).map(leap).sum::<f32>()
            };
            let drawn_out = change([0.01, 0.0]) / change([0.0, 0.01]);
            assert!((0.6..1.6).contains(&drawn_out), "{drawn_out} times as long down {rise:?}");
        }
    }

    #[test]
    fn it_varies_as_much_on_every_slope() {
        let deviation = |steep: f32| {
            let values = (0..4000)
                .map(|number| at([0.8 * steep, 0.6 * steep], 0.37 * number as f32, 0.91 * number as f32));
            (values.map(|grain| grain.value * grain.value).sum::<f32>() / 4000.0).sqrt()
        };
        let level = deviation(0.0);
        for steep in [0.4, 0.8, 1.0, 1.3, 2.0, 6.0] {
            let share = deviation(steep) / level;
            assert!((0.85..1.15).contains(&share), "{share} at {steep}");
        }
    }

    #[test]
    fn its_slope_is_that_of_its_value_on_the_ground() {
        for rise in [[0.3, 0.1], [1.0, 0.6], [-2.0, 1.0]] {
            for number in 0..200_u16 {
                let place = [0.373, 0.717].map(|pace: f32| pace * f32::from(number));
                let value = |east: f32, north: f32| {
                    let [x, y] = [place[0] + east, place[1] + north];
                    on_slope(OCTAVES, [x, y, rise[0] * x + rise[1] * y], rise, 0.001).value
                };
                let here = on_slope(
                    OCTAVES,
                    [place[0], place[1], rise[0] * place[0] + rise[1] * place[1]],
                    rise,
                    0.001,
                );
                let step = 2e-4;
                let measured = [
                    (value(step, 0.0) - value(-step, 0.0)) / (2.0 * step),
                    (value(0.0, step) - value(0.0, -step)) / (2.0 * step),
                ];
                for axis in 0..2 {
                    let off = (here.slope[axis] - measured[axis]).abs();
                    assert!(off < 0.05 * measured[axis].abs() + 2.0, "{:?} for {measured:?}", here.slope);
                }
            }
        }
    }
}
