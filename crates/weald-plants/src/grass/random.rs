//! Chance and angles that a device computes as the CPU does: hashes of whole numbers, and polynomials for sine and cosine,
//! which drivers compute each in its own way.

/// A number from 0 to 1, for each blade of a set and each purpose its own.
///
/// The rounds are those of Jarzynski and Olano 2020, "Hash functions for GPU rendering" (`pcg`).
#[inline]
pub(super) fn random(seed: u32, blade: u32, purpose: u32) -> f32 {
    let bits = scrambled(scrambled(seed) ^ (blade * 16 + purpose));
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[inline]
fn scrambled(number: u32) -> u32 {
    let state = number.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// The sine of an angle from -π/3 to π/3, by nine terms of its series: within 1.2e-7.
#[inline]
pub(super) fn sine(x: f32) -> f32 {
    let s = x * x;
    x * (1.0 - s * (0.166_666_67 - s * (0.008_333_333 - s * (0.000_198_412_7 - s * 0.000_002_755_731_9))))
}

/// The cosine of an angle from -π/3 to π/3, by ten terms of its series: within 1.2e-7.
#[inline]
pub(super) fn cosine(x: f32) -> f32 {
    let s = x * x;
    let fine = 0.001_388_888_9 - s * (0.000_024_801_587 - s * 0.000_000_275_573_2);
    1.0 - s * (0.5 - s * (0.041_666_668 - s * fine))
}

/// The direction so many turns from the first axis to the second, for 0 to 1 turns: its cosine and sine.
#[inline]
pub(super) fn direction(turns: f32) -> [f32; 2] {
    let quarters = turns * 4.0;
    let quadrant = (quarters + 0.5).floor();
    let angle = (quarters - quadrant) * std::f32::consts::FRAC_PI_2;
    let (along, across) = (cosine(angle), sine(angle));
    match quadrant as u32 % 4 {
        0 => [along, across],
        1 => [-across, along],
        2 => [-along, -across],
        _ => [across, -along],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_sine_and_cosine_to_the_last_places() {
        for step in -1000..=1000 {
            let x = step as f32 / 1000.0 * std::f32::consts::FRAC_PI_3;
            let (true_sine, true_cosine) = libm::sincos(f64::from(x));
            assert!((f64::from(sine(x)) - true_sine).abs() < 1.2e-7, "sine of {x}");
            assert!((f64::from(cosine(x)) - true_cosine).abs() < 1.2e-7, "cosine of {x}");
        }
    }

    #[test]
    fn directions_go_once_around_without_a_jump() {
        for step in 0..=4000 {
            let turns = step as f32 / 4000.0;
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * f64::from(turns));
            let [x, y] = direction(turns).map(f64::from);
            assert!((x - cosine).abs() < 5e-7 && (y - sine).abs() < 5e-7, "{turns}: {x} {y}");
        }
    }

    #[test]
    fn lots_fill_their_interval_evenly_and_differ_by_blade_and_purpose() {
        let of_seeds = |blade, purpose| (0..10_000).map(move |seed| random(seed, blade, purpose));
        for blade in 0..6 {
            for purpose in 0..6 {
                let mean = of_seeds(blade, purpose).sum::<f32>() / 10_000.0;
                assert!((mean - 0.5).abs() < 0.02, "blade {blade}, purpose {purpose}: {mean}");
                assert!(of_seeds(blade, purpose).all(|random| (0.0..1.0).contains(&random)));
            }
        }
        let same = of_seeds(0, 0).zip(of_seeds(1, 0)).zip(of_seeds(0, 1));
        assert!(same.filter(|((a, b), c)| a == b || a == c).count() < 10);
    }
}
