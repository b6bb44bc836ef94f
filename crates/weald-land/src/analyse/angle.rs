//! Angles without branches, so that rows of them are computed in vectors, with the bits of `libm`, which has them from
//! `FreeBSD`'s `s_atan.c` and `e_atan2.c` (Sun Microsystems 1993): the argument is brought near 0 by what is known of
//! the tangents of five angles, and a polynomial does the rest.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Where an argument is no longer near the angle before it, and the angle it is near then: its high and low part.
const NEAR: [(f64, f64, f64); 4] = [
    (7.0 / 16.0, 4.636_476_090_008_061e-1, 2.269_877_745_296_168_7e-17),
    (11.0 / 16.0, FRAC_PI_4, 3.061_616_997_868_383e-17),
    (19.0 / 16.0, 9.827_937_232_473_29e-1, 1.390_331_103_123_099_8e-17),
    (39.0 / 16.0, FRAC_PI_2, 6.123_233_995_736_766e-17),
];

/// Coefficients of the odd powers, from the third on.
const SERIES: [f64; 11] = [
    3.333_333_333_333_293e-1,
    -1.999_999_999_987_648_3e-1,
    1.428_571_427_250_346_6e-1,
    -1.111_111_040_546_235_6e-1,
    9.090_887_133_436_507e-2,
    -7.691_876_205_044_83e-2,
    6.661_073_137_387_531e-2,
    -5.833_570_133_790_573_5e-2,
    4.976_877_994_615_932e-2,
    -3.653_157_274_421_691_6e-2,
    1.628_582_011_536_578_2e-2,
];

/// What π has beyond 53 bits.
const PI_LOW: f64 = 1.224_646_799_147_353_2e-16;

/// The angle of a tangent that is not negative.
#[inline(always)]
pub(super) fn of_tangent(tangent: f64) -> f64 {
    let x = tangent;
    let near = [(2.0 * x - 1.0, 2.0 + x), (x - 1.0, x + 1.0), (x - 1.5, 1.0 + 1.5 * x), (-1.0, x)];
    let (mut numerator, mut denominator, mut high, mut low) = (x, 1.0, 0.0, 0.0);
    for ((least, angle, rest), (above, below)) in NEAR.into_iter().zip(near) {
        let is_past = x >= least;
        numerator = if is_past { above } else { numerator };
        denominator = if is_past { below } else { denominator };
        high = if is_past { angle } else { high };
        low = if is_past { rest } else { low };
    }
    let x = numerator / denominator;
    high - ((x * odd_powers(x) - low) - x)
}

/// What is missing from an argument near 0 to its angle, as a share of it.
#[inline(always)]
fn odd_powers(x: f64) -> f64 {
    let [a, b, c, d, e, f, g, h, i, j, k] = SERIES;
    let square = x * x;
    let fourth = square * square;
    let even = square * (a + fourth * (c + fourth * (e + fourth * (g + fourth * (i + fourth * k)))));
    let odd = fourth * (b + fourth * (d + fourth * (f + fourth * (h + fourth * j))));
    even + odd
}

/// The angle of a direction against the axis of `x`, from -π to π; at least one of the two is not 0.
#[inline(always)]
pub(super) fn of_direction(y: f64, x: f64) -> f64 {
    let angle = of_tangent((y / x).abs());
    let angle = if x < 0.0 { PI - (angle - PI_LOW) } else { angle };
    if y < 0.0 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn where_the_angle_before_ends_it_is_that_of_the_library() {
        for (least, ..) in NEAR {
            for tangent in [least.next_down(), least, least.next_up()] {
                assert_eq!(of_tangent(tangent), libm::atan(tangent), "{tangent}");
            }
        }
        assert_eq!([0.0, 1.0, f64::INFINITY].map(of_tangent), [0.0, 0.25 * PI, 0.5 * PI]);
    }

    proptest! {
        #[test]
        fn angles_have_the_bits_of_the_library(y in -1.0e4..1.0e4_f64, x in -1.0e4..1.0e4_f64, exponent in -40..40) {
            let tangent = y.abs() * libm::exp2(f64::from(exponent));
            prop_assert_eq!(of_tangent(tangent), libm::atan(tangent));
            for (y, x) in [(y, x), (y, 0.0), (0.0, x), (y * 1.0e-12, x), (y, x * 1.0e-12)] {
                prop_assert_eq!(of_direction(y, x), libm::atan2(y, x), "of {} and {}", y, x);
            }
        }
    }
}
