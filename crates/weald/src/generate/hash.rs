//! Random numbers for whole rows of cells: 32-bit integer hashes that vectorise, and that a shader without
//! 64-bit integers computes to the same bits.
//!
//! The finaliser is `lowbias32` (C. Wellons, "Prospecting for Hash Functions", 2018): a bijection of 32-bit
//! numbers in which each input bit flips each output bit with a probability within 0.1 % of one half. A cell
//! is hashed in two rounds, row first, so that a row's round is done once.

use crate::random::splitmix64;

/// An odd number near 2^32 divided by the golden ratio: spreads neighbouring columns over all bits before the
/// row's key is mixed in, so that no two rows are shifted copies of each other.
const SPREAD: u32 = 0x9e37_79b9;

/// One round of `lowbias32`.
#[inline(always)]
pub fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// A family of random numbers on a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane([u32; 2]);

impl Plane {
    /// The family number `index` (octave, level) of a seed.
    pub fn new(seed: u64, index: u64) -> Self {
        let bits = splitmix64(splitmix64(seed) ^ index);
        Self([bits as u32, (bits >> 32) as u32])
    }

    /// The key of lattice row `y`.
    #[inline(always)]
    pub fn row(self, y: i32) -> RowKey {
        RowKey(mix((y as u32).wrapping_mul(SPREAD) ^ self.0[0]) ^ self.0[1])
    }
}

/// The random numbers of one lattice row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowKey(u32);

impl RowKey {
    /// 32 random bits for lattice column `x`.
    #[inline(always)]
    pub fn bits(self, x: i32) -> u32 {
        mix((x as u32).wrapping_mul(SPREAD) ^ self.0)
    }

    /// Uniform in [-1, 1): the top 24 bits, all that an `f32` holds.
    #[inline(always)]
    pub fn signed(self, x: i32) -> f32 {
        ((self.bits(x) as i32) >> 8) as f32 * (1.0 / 8_388_608.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: i32 = 512;

    fn values(seed: u64) -> Vec<f64> {
        let plane = Plane::new(seed, 0);
        (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| f64::from(plane.row(y).signed(x)))).collect()
    }

    fn correlation(values: &[f64], apart: usize) -> f64 {
        let pairs = values.iter().zip(&values[apart..]);
        3.0 * pairs.map(|(a, b)| a * b).sum::<f64>() / (values.len() - apart) as f64
    }

    #[test]
    fn values_are_uniform_by_the_chi_squared_test() {
        for seed in 0..8 {
            let mut bins = [0.0_f64; 256];
            for value in values(seed) {
                assert!((-1.0..1.0).contains(&value));
                bins[((value + 1.0) * 128.0) as usize] += 1.0;
            }
            let expected = f64::from(SIDE * SIDE) / 256.0;
            let chi_squared: f64 = bins.iter().map(|n| (n - expected).powi(2) / expected).sum();
            // 255 degrees of freedom: mean 255, standard deviation 22.6; five of them on either side.
            assert!((142.0..368.0).contains(&chi_squared), "seed {seed}: {chi_squared}");
        }
    }

    #[test]
    fn neighbouring_cells_rows_levels_and_seeds_do_not_correlate() {
        // One standard deviation of a correlation over 512² pairs is 0.002.
        let values_of_seed = values(3);
        for apart in [1, 2, 16, 511, 512, 513, 1024] {
            let r = correlation(&values_of_seed, apart);
            assert!(r.abs() < 0.01, "{apart} cells apart: {r}");
        }
        let both: Vec<f64> = values_of_seed.into_iter().chain(values(4)).collect();
        assert!(correlation(&both, (SIDE * SIDE) as usize).abs() < 0.01);
    }

    #[test]
    fn the_mixer_gives_the_published_avalanche() {
        let mut flips = 0;
        for input in 0..4096_u32 {
            let input = input.wrapping_mul(0x0101_4301);
            flips += (0..32).map(|bit| (mix(input) ^ mix(input ^ (1 << bit))).count_ones()).sum::<u32>();
        }
        let share = f64::from(flips) / (4096.0 * 32.0 * 32.0);
        assert!((share - 0.5).abs() < 0.002, "{share}");
    }
}
