//! Random iteration on a device: fills pieces with the points of a game.

use weald::Error;
use weald::grow::ifs::Game;
use weald::grow::ifs::device::{PLAY, Rules};
use weald::grow::ifs::game::CHUNK;
use weald::grow::ifs::lanes::LANES;

use super::pass::{self, Pass, Work};
use super::points::{BYTES, Piece, Points};
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::Pace;
use crate::slots::Slots;

/// A game that a device can play.
#[derive(Debug)]
pub(crate) struct Play<'a> {
    game: Game<'a>,
    pass: Pass,
    rules: Rules,
    uniform: Slots,
    maps: Store,
    bounds: Store,
    /// Bytes that are written for a point.
    bytes: u64,
}

impl<'a> Play<'a> {
    /// With codes, where these are wanted.
    pub(crate) fn new(gpu: &Gpu, game: Game<'a>, coded: bool) -> Result<Self, Error> {
        let rules = game.rules(coded);
        Ok(Self {
            pass: Pass::new(gpu, &PLAY)?,
            uniform: pass::uniform(gpu, "the rules of random iteration", &rules)?,
            maps: pass::table(gpu, "the maps of a fractal", &game.table().maps)?,
            bounds: pass::table(gpu, "the bounds of draws", &game.table().bounds)?,
            bytes: if coded { 2 * BYTES } else { BYTES },
            rules,
            game,
        })
    }

    /// Fills all pieces, from the first chunk of the game on.
    pub(crate) fn fill(&self, points: &mut Points) -> Result<(), Error> {
        let Points { gpu, pace, pieces, .. } = points;
        let mut chunk = 0;
        for piece in pieces.iter() {
            let chunks = u64::from(piece.count).div_ceil(CHUNK);
            self.fill_piece(gpu, pace, piece, chunk..chunk + chunks)?;
            chunk += chunks;
        }
        Ok(())
    }

    fn fill_piece(
        &self,
        gpu: &Gpu,
        pace: &mut Pace,
        piece: &Piece,
        chunks: std::ops::Range<u64>,
    ) -> Result<(), Error> {
        let keys: Vec<[u32; 2]> = chunks
            .flat_map(|chunk| {
                let [low, high] = self.game.keys(chunk);
                (0..LANES).map(move |lane| [low[lane], high[lane]])
            })
            .collect();
        let keys = pass::table(gpu, "the keys of lanes", &keys)?;
        let buffers = [&self.maps, &self.bounds, &keys, &piece.rests, &piece.codes];
        let bound = self.pass.bind(gpu, &[&self.uniform], &buffers)?;
        let of_a_group = self.rules.segment * LANES as u32;
        let work = Work { bound: &bound, points: piece.count, of_a_group, bytes: self.bytes, given: None };
        self.pass.run(gpu, pace, work)?;
        pace.drain(gpu)
    }
}
