//! Codes of many points at once: each step pushes its map into the packed codes of all lanes.
//!
//! A code shifts by one digit to its fine end and takes the newest map at its coarse end, which for lanes side by side is
//! a handful of vector operations a word, however many digits a code has.

use super::code::{Code, Digits};
use super::game::Block;
use super::lanes::LANES;
use super::system::Ifs;
use weald_core::vectors::widest;

/// One word of the codes of all lanes.
pub type Words = [u64; LANES];

/// Packs the codes of a game's blocks, which it is given in their order.
#[derive(Clone, Debug)]
pub struct Packer {
    digits: Digits,
    code_digits: usize,
    state: [Words; 4],
    /// Number of the point after those seen, to know where a chunk begins anew.
    next: Option<u64>,
    rows: Vec<[Words; 4]>,
}

impl Packer {
    /// For the points of a fractal.
    pub fn of(ifs: &Ifs) -> Self {
        let (digits, code_digits) = (ifs.digits(), ifs.code_digits());
        Self { digits, code_digits, state: [[0; LANES]; 4], next: None, rows: Vec::new() }
    }

    /// Packs the codes of a block: four words for each lane of each row, coarsest first.
    pub fn pack(&mut self, block: &Block) -> &[[Words; 4]] {
        if self.next != Some(block.first) {
            self.state = [[0; LANES]; 4];
            let mut unused = vec![[[0; LANES]; 4]; block.history().len()];
            self.push(block.history(), &mut unused);
        }
        let taken = block.taken();
        let mut rows = std::mem::take(&mut self.rows);
        rows.resize(taken.len(), [[0; LANES]; 4]);
        self.push(taken, &mut rows);
        self.rows = rows;
        self.next = Some(block.first + block.len() as u64);
        &self.rows
    }

    /// The code of a point of the block that was packed last.
    #[inline]
    pub fn code(&self, number: usize) -> Code {
        let (row, lane) = (number / LANES, number % LANES);
        Code::of_words(self.digits, self.code_digits, self.rows[row].map(|word| word[lane]))
    }

    fn push(&mut self, taken: &[[u8; LANES]], rows: &mut [[Words; 4]]) {
        let bits = self.digits.bits() as u32;
        let used = (self.code_digits * self.digits.bits()).div_ceil(64);
        let last = self.code_digits * self.digits.bits() - 64 * (used - 1);
        let kept = u64::MAX << (64 - last);
        match used {
            1 => push::<1>(&mut self.state, taken, rows, bits, kept),
            2 => push::<2>(&mut self.state, taken, rows, bits, kept),
            3 => push::<3>(&mut self.state, taken, rows, bits, kept),
            _ => push::<4>(&mut self.state, taken, rows, bits, kept),
        }
    }
}

/// Pushes rows of maps into codes of `USED` words, of the last of which the bits of `kept` count.
fn push<const USED: usize>(
    state: &mut [Words; 4],
    taken: &[[u8; LANES]],
    rows: &mut [[Words; 4]],
    bits: u32,
    kept: u64,
) {
    widest(
        #[inline(always)]
        || {
            let (bits, kept) = (bits, kept);
            for (taken, row) in taken.iter().zip(rows.iter_mut()) {
                for word in (0..USED).rev() {
                    for lane in 0..LANES {
                        let finer = state[word][lane] >> bits;
                        let carried = if word == 0 { u64::from(taken[lane]) } else { state[word - 1][lane] };
                        let shifted = finer | (carried << (64 - bits));
                        let shifted = if word + 1 == USED { shifted & kept } else { shifted };
                        state[word][lane] = shifted;
                        row[word][lane] = shifted;
                    }
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::game::{CHUNK, Game};
    use crate::ifs::shapes::SHAPES;

    #[test]
    fn codes_packed_together_are_those_packed_one_by_one() {
        for shape in SHAPES {
            let ifs = shape.ifs();
            let mut packer = Packer::of(&ifs);
            let mut seen = 0;
            let game = Game::new(&ifs, 4);
            for chunk in [0, 2, 3] {
                game.chunk(chunk, CHUNK.min(5_000), |block| {
                    packer.pack(block);
                    for i in 0..block.len() {
                        assert_eq!(packer.code(i), block.code(i, &ifs), "{} {}", shape.name, block.first);
                        seen += 1;
                    }
                });
            }
            assert_eq!(seen, 15_000);
        }
    }
}
