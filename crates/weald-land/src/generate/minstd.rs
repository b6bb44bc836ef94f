//! `minstd_rand0`, the "minimal standard" generator: `x ← 16807 x mod (2^31 - 1)`.
//!
//! Park and Miller 1988, doi 10.1145/63039.63042; the C++ standard names it and states its 10,000th number.
//! It is here because fault formation is published with it; everything else hashes.

const MODULUS: u64 = 2_147_483_647;
const MULTIPLIER: u64 = 16_807;

/// The generator's state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Minstd(u64);

impl Minstd {
    /// A generator; a seed that is a multiple of the modulus stands for 1, as in the C++ standard.
    pub fn new(seed: u64) -> Self {
        Self((seed % MODULUS).max(1))
    }

    /// The next number, from 1 to 2^31 - 2.
    pub fn draw(&mut self) -> u64 {
        self.0 = self.0 * MULTIPLIER % MODULUS;
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_10000th_number_from_seed_1_is_the_one_in_the_standard() {
        let mut generator = Minstd::new(1);
        let last = (0..10_000).map(|_| generator.draw()).last();
        assert_eq!(last, Some(1_043_618_065));
    }

    #[test]
    fn a_seed_of_nothing_is_a_seed_of_one() {
        assert_eq!(Minstd::new(0), Minstd::new(1));
        assert_eq!(Minstd::new(MODULUS), Minstd::new(1));
    }
}
