//! Random iteration, the "chaos game": points of a fractal by taking its maps at random.
//!
//! `x ← F_m(x)`, each `m` drawn with its probability; after as many steps as a code has digits, the last maps taken
//! are, newest first, the code of the point. Source: Barnsley 1988, "Fractals everywhere", section III.8.
//!
//! What differs: 64 points run side by side in **lanes**, so that vectors hold them and no step waits for the one
//! before. Lanes make up **chunks**, each of which begins anew at the root and forgets it for as many steps as a
//! code has digits. A draw is a hash of (seed, chunk, lane, step): any chunk can be made anywhere, so points are the
//! same for any number of threads. A draw has 16 bits, so probabilities are rounded to 1/65536.

use super::code::Code;
use super::lanes::{self, LANES, Lanes, Row};
use super::system::{Ifs, MIN_PROBABILITY};
use super::table::Table;
use weald_core::random::splitmix64;

/// Steps of a chunk whose points count.
pub const STEPS: usize = 4096;

/// Points of a chunk.
pub const CHUNK: u64 = (STEPS * LANES) as u64;

/// Steps handed over at a time: their points fit the first-level cache beside what is made of them.
pub(super) const BLOCK_STEPS: usize = 32;

/// Random iteration of one fractal.
#[derive(Clone, Debug)]
pub struct Game<'a> {
    pub(super) ifs: &'a Ifs,
    table: Table,
    seed: u64,
}

/// Some points in the order of the game, with the maps that led to them.
#[derive(Clone, Debug)]
pub struct Block {
    /// Number of its first point in the game.
    pub first: u64,
    points: Vec<[Row; 3]>,
    /// Maps taken, a row a step; the first `history` rows are those before the first point.
    taken: Vec<[u8; LANES]>,
    history: usize,
    count: usize,
}

impl<'a> Game<'a> {
    /// The game of a fractal; the same seed gives the same points.
    pub fn new(ifs: &'a Ifs, seed: u64) -> Self {
        Self { ifs, table: Table::of(ifs), seed }
    }

    /// Its maps and their bounds.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The key of each lane of a chunk, in two words.
    pub fn keys(&self, chunk: u64) -> [[u32; LANES]; 2] {
        let key = splitmix64(self.seed ^ splitmix64(chunk));
        let keys: [u64; LANES] = std::array::from_fn(|lane| splitmix64(key ^ lane as u64));
        [keys.map(|key| key as u32), keys.map(|key| (key >> 32) as u32)]
    }

    /// Shares that the maps really get, in 65536ths.
    pub fn shares(&self) -> Vec<u32> {
        self.table.shares()
    }

    /// Plays one chunk of `points` points, at most [`CHUNK`], and shows them block by block.
    pub fn chunk(&self, chunk: u64, points: u64, mut look: impl FnMut(&Block)) {
        let history = self.ifs.code_digits();
        let mut lanes = Lanes::at_root(self.ifs, &self.keys(chunk));
        let mut block = Block {
            first: chunk * CHUNK,
            points: vec![[[0.0; LANES]; 3]; BLOCK_STEPS],
            taken: vec![[0; LANES]; history + BLOCK_STEPS],
            history,
            count: 0,
        };
        self.warm_up(&mut lanes, &mut block);
        let end = block.first + points.min(CHUNK);
        while block.first < end {
            self.play(&mut lanes, &mut block, BLOCK_STEPS);
            block.count = (end - block.first).min((BLOCK_STEPS * LANES) as u64) as usize;
            look(&block);
            block.forget_oldest();
            block.first += block.count as u64;
        }
    }

    /// Forgets the root: plays `history` steps whose points do not count.
    fn warm_up(&self, lanes: &mut Lanes, block: &mut Block) {
        let mut left = block.history;
        while left > 0 {
            let steps = left.min(BLOCK_STEPS);
            self.play(lanes, block, steps);
            block.taken.copy_within(steps..steps + block.history, 0);
            left -= steps;
        }
    }

    /// The next steps, into the rows of the block after its history.
    fn play(&self, lanes: &mut Lanes, block: &mut Block, steps: usize) {
        let taken = &mut block.taken[block.history..block.history + steps];
        lanes::play(&self.table, lanes, &mut block.points[..steps], taken);
    }

    /// The first `points` points in order, one after the other on this thread.
    pub fn points(&self, points: u64, mut look: impl FnMut(&Block)) {
        for chunk in 0..points.div_ceil(CHUNK) {
            self.chunk(chunk, points - chunk * CHUNK, &mut look);
        }
    }
}

impl Block {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Rows of [`LANES`] points; of the last row, only those up to [`Block::len`] count.
    pub fn rows(&self) -> &[[Row; 3]] {
        &self.points[..self.count.div_ceil(LANES)]
    }

    /// Maps taken before the first point, a row a step: as many as a code has digits.
    pub(super) fn history(&self) -> &[[u8; LANES]] {
        &self.taken[..self.history]
    }

    /// Maps taken on the way to the points, a row a step.
    pub(super) fn taken(&self) -> &[[u8; LANES]] {
        &self.taken[self.history..][..self.count.div_ceil(LANES)]
    }

    /// The maps that were taken last on the way to the points of a row: the coarsest digits of their codes.
    pub fn coarsest(&self, row: usize) -> &[u8; LANES] {
        &self.taken[self.history + row]
    }

    /// A digit of the codes of a row of points, coarsest first from 0.
    #[inline]
    pub fn digits(&self, row: usize, place: usize) -> &[u8; LANES] {
        &self.taken[self.history + row - place]
    }

    /// One point.
    #[inline]
    pub fn point(&self, number: usize) -> [f32; 3] {
        let row = &self.points[number / LANES];
        row.map(|axis| axis[number % LANES])
    }

    /// A digit of the code of a point, coarsest first from 0.
    #[inline]
    pub fn digit(&self, number: usize, place: usize) -> u8 {
        let row = self.history + number / LANES;
        self.taken[row - place][number % LANES]
    }

    /// The code of a point.
    pub fn code(&self, number: usize, ifs: &Ifs) -> Code {
        let (row, lane) = (self.history + number / LANES, number % LANES);
        Code::packed(ifs.digits(), (0..ifs.code_digits()).map(|place| self.taken[row - place][lane]))
    }

    fn forget_oldest(&mut self) {
        let rows = self.points.len();
        self.taken.copy_within(rows.., 0);
    }
}

const _: () = assert!(MIN_PROBABILITY * 65536.0 == 1.0, "a draw has 16 bits");
