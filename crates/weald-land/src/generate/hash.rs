//! Random numbers for lattice points: 32-bit integer hashes that vectorise, and that a shader without 64-bit
//! integers computes to the same bits.
//!
//! ```text
//! bits(x, y) = m(EAST x + SOUTH y + start)      modulo 2^32
//! ```
//!
//! where `m` is the finaliser `lowbias32` (C. Wellons, "Prospecting for Hash Functions", 2018), a bijection
//! of 32-bit numbers in which each input bit flips each output bit with a probability near one half. What
//! differs: a key is mixed in between its rounds, since `start` alone would only move the pattern.
//!
//! Points repeat where `EAST x + SOUTH y` is a multiple of 2^32. The two constants are the fractions of 2^32
//! given by the plastic number (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018),
//! which spread points so evenly that equal ones lie more than 2^15 steps apart.

use weald_core::random::splitmix64;

/// What a step to the east adds to a point's number.
pub const EAST: u32 = 0xc13f_a9a9;

/// What a step to the south adds.
pub const SOUTH: u32 = 0x91e1_0da5;

/// The random numbers of one seed and one index (octave, level).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    start: u32,
    key: u32,
}

impl Plane {
    /// The plane number `index` of a seed.
    pub fn new(seed: u64, index: u64) -> Self {
        let bits = splitmix64(splitmix64(seed) ^ index);
        Self { start: bits as u32, key: (bits >> 32) as u32 }
    }

    /// Start and key, for shaders.
    pub(crate) fn words(self) -> [u32; 2] {
        [self.start, self.key]
    }

    /// The number of a point, to which [`EAST`] and [`SOUTH`] may be added.
    #[inline(always)]
    pub fn point(self, x: i32, y: i32) -> u32 {
        (x as u32).wrapping_mul(EAST).wrapping_add((y as u32).wrapping_mul(SOUTH).wrapping_add(self.start))
    }

    /// 32 random bits for a point. The higher bits are the better ones.
    #[inline(always)]
    pub fn bits(self, point: u32) -> u32 {
        let mut bits = point ^ (point >> 16);
        bits = bits.wrapping_mul(0x7feb_352d);
        bits ^= (bits >> 15) ^ self.key;
        // The last round of `lowbias32`, a shift by 16, would only better the lower half.
        bits.wrapping_mul(0x846c_a68b)
    }

    /// Uniform in [-1, 1): the top 24 bits, all that an `f32` holds.
    #[inline(always)]
    pub fn signed(self, x: i32, y: i32) -> f32 {
        ((self.bits(self.point(x, y)) as i32) >> 8) as f32 * (1.0 / 8_388_608.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_engine::program::twin::number;

    const SIDE: i32 = 512;

    fn values(seed: u64) -> Vec<f64> {
        let plane = Plane::new(seed, 0);
        (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| f64::from(plane.signed(x, y)))).collect()
    }

    fn correlation(values: &[f64], apart: usize) -> f64 {
        let pairs = values.iter().zip(&values[apart..]);
        3.0 * pairs.map(|(a, b)| a * b).sum::<f64>() / (values.len() - apart) as f64
    }

    #[test]
    fn the_shader_has_the_same_constants() {
        let shader = include_str!("hash.wgsl");
        assert_eq!(number(shader, "STEP_EAST"), f64::from(EAST));
        assert_eq!(number(shader, "STEP_SOUTH"), f64::from(SOUTH));
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
    fn every_bit_of_a_point_flips_half_of_the_higher_bits() {
        let plane = Plane::new(9, 0);
        for bit in 0..32 {
            let flipped = |input: u32| (plane.bits(input) ^ plane.bits(input ^ (1 << bit))) >> 16;
            let flips: u32 = (0..4096_u32).map(|k| flipped(k.wrapping_mul(0x0101_4301)).count_ones()).sum();
            let share = f64::from(flips) / (4096.0 * 16.0);
            assert!((share - 0.5).abs() < 0.05, "bit {bit}: {share}");
        }
    }

    #[test]
    fn equal_points_lie_more_than_32768_steps_apart() {
        // Gauss's reduction of the lattice of steps (x, y) with EAST x + SOUTH y = 0 modulo 2^32.
        let inverse = (0..5).fold(EAST, |x, _| x.wrapping_mul(2_u32.wrapping_sub(EAST.wrapping_mul(x))));
        let product = |a: [i64; 2], b: [i64; 2]| a[0] as f64 * b[0] as f64 + a[1] as f64 * b[1] as f64;
        let length = |v: [i64; 2]| product(v, v);
        let (mut long, mut short) =
            ([1_i64 << 32, 0], [i64::from(SOUTH.wrapping_mul(inverse).wrapping_neg()), 1]);
        assert_eq!(EAST.wrapping_mul(short[0] as u32).wrapping_add(SOUTH), 0);
        while length(short) < length(long) {
            (long, short) = (short, long);
            let times = (product(long, short) / length(long)).round() as i64;
            short = [short[0] - times * long[0], short[1] - times * long[1]];
        }
        assert!(length(long).sqrt() > 32_768.0, "{long:?}");
    }
}
