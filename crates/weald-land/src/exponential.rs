//! Powers, exponentials and logarithms to some nine digits, in vectors and much faster than those of `libm`: the logarithm by the
//! series of the inverse hyperbolic tangent, the exponential by Taylor's. Nothing in them branches, so that a row of cells is computed
//! side by side.

/// `base^exponent` for a positive base. For other bases it is a number without meaning.
#[inline(always)]
pub(crate) fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 1.0 {
        return base;
    }
    exp2(exponent * log2(base))
}

/// Logarithm to base 2 of a positive normal number.
#[inline(always)]
pub(crate) fn log2(number: f64) -> f64 {
    const SHIFT: u64 = 0x3fe6_a09e_667f_3bcd; // bits of the root of one half, the least mantissa
    let above = number.to_bits().wrapping_sub(SHIFT);
    let whole = ((above as i64) >> 52) as i32;
    let mantissa = f64::from_bits(number.to_bits().wrapping_sub((i64::from(whole) as u64) << 52));
    let t = (mantissa - 1.0) / (mantissa + 1.0);
    let square = t * t;
    let series = 1.0 + square * (1.0 / 3.0 + square * (0.2 + square * (1.0 / 7.0 + square * (1.0 / 9.0))));
    f64::from(whole) + 2.0 * std::f64::consts::LOG2_E * t * series
}

/// `2^number`, within 2^±1000, so that sums of weights are finite and no lower neighbour is left out.
#[inline(always)]
pub(crate) fn exp2(number: f64) -> f64 {
    // A number this large has its units in its last bits: adding it rounds to a whole number and leaves that there.
    const ROUNDING: f64 = 1.5 * (1_u64 << 52) as f64;
    let number = number.clamp(-1000.0, 1000.0);
    let rounded = number + ROUNDING;
    let x = (number - (rounded - ROUNDING)) * std::f64::consts::LN_2;
    let [a, b, c, d, e, f, g] = INVERSE_FACTORIALS;
    let series = 1.0 + x * (1.0 + x * (a + x * (b + x * (c + x * (d + x * (e + x * (f + x * g)))))));
    series * f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52)
}

/// One over 2!, 3! … 8!.
const INVERSE_FACTORIALS: [f64; 7] =
    [0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_library() {
        for base in [1.0e-30, 3.7e-9, 0.02, 0.5, 0.707, 1.0, 1.41, 1.42, 2.0, 17.5, 9.9e11] {
            for exponent in [0.0, 0.5, 1.0, 1.1, 4.0, 8.5] {
                let (ours, exact) = (power(base, exponent), libm::pow(base, exponent));
                assert!((ours / exact - 1.0).abs() < 1e-7, "{base}^{exponent} is {ours}, not {exact}");
            }
        }
    }

    #[test]
    fn exponentials_and_logarithms_are_those_of_the_library() {
        for number in [-1000.0, -333.25, -1.5, -0.5, -1.0e-12, 0.0, 0.3, 0.5, 1.0, 52.75, 1000.0] {
            let (ours, exact) = (exp2(number), libm::exp2(number));
            assert!((ours / exact - 1.0).abs() < 1e-8, "2^{number} is {ours}, not {exact}");
        }
        for number in [f64::MIN_POSITIVE, 1.0e-200, 0.3, 0.999_999, 1.0, 1.000_001, 1.414, 1.415, 7.0e250] {
            let (ours, exact) = (log2(number), libm::log2(number));
            assert!((ours - exact).abs() < 2e-9, "the logarithm of {number} is {ours}, not {exact}");
        }
    }
}
