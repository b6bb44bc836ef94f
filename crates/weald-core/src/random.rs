//! Random numbers as a function of (seed, step, cell): no generator, no order, the same bits on any engine.
//!
//! `SplitMix64` (Steele, Lea, Flood 2014, doi 10.1145/2660193.2660195) finalises each input in turn.

/// One round of `SplitMix64`: a bijection of 64-bit numbers whose output bits all depend on all input bits.
#[inline]
pub fn splitmix64(state: u64) -> u64 {
    let mut z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 64 random bits for a cell: `splitmix64` chained over seed, `x` and `y`.
#[inline]
pub fn hash2(seed: u64, x: i64, y: i64) -> u64 {
    splitmix64(splitmix64(splitmix64(seed) ^ x as u64) ^ y as u64)
}

/// Uniform in [0, 1) from the top 53 bits.
#[inline]
pub fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// Uniform in [-1, 1) for a cell.
#[inline]
pub fn signed2(seed: u64, x: i64, y: i64) -> f64 {
    2.0 * unit(hash2(seed, x, y)) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splitmix64_gives_the_published_first_output_of_seed_zero() {
        assert_eq!(splitmix64(0), 0xe220_a839_7b1d_cdaf);
    }

    #[test]
    fn signed_values_fill_their_interval_evenly() {
        let count = 100_000;
        let mean = (0..count).map(|i| signed2(7, i, -i)).sum::<f64>() / count as f64;
        assert!(mean.abs() < 0.01, "mean {mean}");
        assert!((0..count).all(|i| (-1.0..1.0).contains(&signed2(7, i, i))));
    }
}
