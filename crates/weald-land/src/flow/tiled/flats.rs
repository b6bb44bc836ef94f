//! Directions of flow in a tile; over flat ground, which may go on in other tiles, by distances that settle at the borders.
//!
//! Distances over a flat are lengths of shortest ways. A tile knows those of its border cells from what the cells around it
//! have: they are found when no tile can shorten any, and are then those of the whole.

use super::borders::Borders;
use super::ground::{cells, place};
use super::planes::MARGIN;
use super::settle::{Passed, settle};
use super::tiling::{Tiling, beside};
use crate::flow::descent::{Descent, FLAT};
use crate::flow::directions::{OUTLET, SEA};
use crate::flow::flats::FlatGround;
use crate::flow::surface::{NO_DATA, Surface};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::plane::{Plane, Window, read_around};

/// No way is known.
const UNKNOWN: u32 = u32::MAX;

/// Distances of the border cells of flats: from those that drain, and from those below higher ground.
pub(super) struct FlatDistances<'a> {
    tiling: &'a Tiling,
    of_cells: Borders<[u32; 2]>,
}

impl<'a> FlatDistances<'a> {
    /// Those of a surface without depressions.
    pub(super) fn of(tiling: &'a Tiling, filled: &dyn Plane<f32>, passed: Passed<'_>) -> Result<Self, Error> {
        let mut found = Borders::filled(tiling, [UNKNOWN; 2]);
        settle(tiling, &mut found, |tile, found| {
            let ground = TileOfFlats::read(tiling, tile, filled)?;
            let distances = ground.distances(tiling, found);
            let mut changed = Vec::new();
            for cell in tiling.border_of(tile) {
                let (at, border) = (ground.place(cell), tiling.border(cell));
                let now = distances.each_ref().map(|of| of.get(at).copied().unwrap_or(UNKNOWN));
                if ground.codes[at] == FLAT && now != found.at(border) {
                    found.set(border, now);
                    changed.push(cell);
                }
            }
            passed(ground.window.size().cells())?;
            Ok(beside(tiling, changed))
        })?;
        Ok(Self { tiling, of_cells: found })
    }

    /// The directions of a tile, row by row.
    pub(super) fn directions(&self, tile: usize, filled: &dyn Plane<f32>) -> Result<Vec<u8>, Error> {
        let ground = TileOfFlats::read(self.tiling, tile, filled)?;
        let distances = ground.distances(self.tiling, &self.of_cells);
        let flat = FlatGround { surface: &ground.surface, codes: &ground.codes };
        let known =
            |cell: usize| distances.each_ref().map(|of| if of[cell] == UNKNOWN { 0 } else { of[cell] });
        let code = |(x, y)| {
            let cell = ground.place([x, y]);
            match ground.codes[cell] {
                _ if ground.surface.is_sea(cell) => SEA,
                FLAT => flat.code(cell, known),
                code if code <= 8 => code,
                _ => OUTLET,
            }
        };
        Ok(cells(&ground.window).map(code).collect())
    }
}

/// A tile and the cells around it, with their steepest descents.
struct TileOfFlats {
    tile: usize,
    window: Window,
    surface: Surface,
    codes: Vec<u8>,
}

impl TileOfFlats {
    fn read(tiling: &Tiling, tile: usize, filled: &dyn Plane<f32>) -> Result<Self, Error> {
        let window = tiling.window(tile);
        let level = read_around(filled, &window, MARGIN, NO_DATA)?;
        let Size { columns, rows } = window.size();
        let size = Size { columns: columns + 2, rows: rows + 2 };
        let surface = Surface { size, stride: columns + 2 * MARGIN, level, elsewhere: Vec::new() };
        let codes = Descent::of(&surface).codes;
        Ok(Self { tile, window, surface, codes })
    }

    fn place(&self, cell: [usize; 2]) -> usize {
        place(&self.window, MARGIN, cell)
    }

    /// Both distances of each cell that belongs to a flat, by what is known of those around the tile; empty without flats.
    fn distances(&self, tiling: &Tiling, known: &Borders<[u32; 2]>) -> [Vec<u32>; 2] {
        let flat = FlatGround { surface: &self.surface, codes: &self.codes };
        let inner = cells(&self.window).map(|(x, y)| self.place([x, y]));
        let inner: Vec<usize> = inner.filter(|&cell| self.codes[cell] == FLAT).collect();
        if inner.is_empty() {
            return Default::default();
        }
        let ring = tiling.ring_of(self.tile).into_iter();
        let ring: Vec<_> = ring
            .map(|cell| (known.at(tiling.border(cell)), self.place(cell)))
            .filter(|&(_, cell)| self.codes[cell] == FLAT)
            .collect();
        let starts: [&dyn Fn(usize) -> bool; 2] =
            [&|cell| flat.drain(cell).is_some(), &|cell| flat.is_below(cell)];
        [0, 1].map(|which| {
            let own = inner.iter().filter(|&&cell| starts[which](cell)).map(|&cell| (1, cell));
            let around = ring.iter().map(|&(distances, cell)| (distances[which], cell));
            self.spread(own.chain(around.filter(|start| start.0 != UNKNOWN)).collect())
        })
    }

    /// Steps from the nearest starting cell, each of which has a distance to begin with.
    fn spread(&self, mut starts: Vec<(u32, usize)>) -> Vec<u32> {
        starts.sort_unstable();
        let mut distance = vec![UNKNOWN; self.codes.len()];
        let (mut queue, mut done) = (Vec::new(), 0);
        let mut starts = starts.into_iter().peekable();
        // Both the starts and the queue are in the order of distances: the nearer of their heads is next.
        loop {
            let queued = queue.get(done).map(|&cell: &usize| distance[cell]);
            if let Some((first, cell)) = starts.next_if(|start| queued.is_none_or(|queued| start.0 <= queued))
            {
                if first >= distance[cell] {
                    continue;
                }
                distance[cell] = first;
                self.pass(cell, &mut distance, &mut queue);
            } else if let Some(&cell) = queue.get(done) {
                done += 1;
                self.pass(cell, &mut distance, &mut queue);
            } else {
                return distance;
            }
        }
    }

    fn pass(&self, cell: usize, distance: &mut [u32], queue: &mut Vec<usize>) {
        let next = distance[cell] + 1;
        for other in self.surface.around(cell) {
            if self.codes[other] == FLAT && next < distance[other] {
                distance[other] = next;
                queue.push(other);
            }
        }
    }
}
