//! Directions over flat ground: away from what is higher and towards where it drains.
//!
//! Barnes, Lehman and Mulla 2014, "An efficient assignment of drainage direction over flat surfaces in raster
//! digital elevation models", doi 10.1016/j.cageo.2013.01.009. Within each flat two distances are counted in
//! cells: `T` from the cells that drain, and `A` from the cells beside higher ground. Each cell drains to the
//! neighbour of least `2 T - A`, which falls along every path, so that there are no cycles and water gathers in
//! the middle. No height is changed. Differs: the greatest `A` of a flat, which the publication adds to keep
//! numbers positive, is left out, as it changes no comparison; flats are resolved in parallel.

use rayon::prelude::*;

use super::descent::{Descent, FLAT};
use super::surface::Surface;

/// Codes from which the first of equal neighbours is taken: straight before diagonal.
const STRAIGHT_FIRST: [u8; 8] = [1, 3, 5, 7, 2, 4, 6, 8];

/// Cells of flats that one task resolves, unless a flat is larger.
const CELLS_PER_TASK: usize = 4096;

/// Gives each cell without a lower neighbour a direction. No height is below all its neighbours: depressions
/// were taken out before.
pub(super) fn resolve(surface: &Surface, descent: &mut Descent) {
    let flats = Flats::of(surface, &descent.codes);
    let codes: Vec<Vec<u8>> =
        flats.tasks().into_par_iter().map(|starts| flats.codes(starts, surface, &descent.codes)).collect();
    for (&cell, code) in flats.cells.iter().zip(codes.into_iter().flatten()) {
        descent.codes[cell as usize] = code;
    }
}

/// Cells without a direction, flat after flat.
struct Flats {
    cells: Vec<u32>,
    /// Where each flat begins among the cells, and the number of cells.
    starts: Vec<usize>,
    /// The place of each cell of the grid among `cells`, where it is one of them.
    place: Vec<u32>,
}

impl Flats {
    fn of(surface: &Surface, codes: &[u8]) -> Self {
        let offsets = surface.offsets();
        let mut flats = Self { cells: Vec::new(), starts: Vec::new(), place: vec![0; codes.len()] };
        let mut open = codes.to_vec();
        for first in 0..codes.len() {
            if open[first] != FLAT {
                continue;
            }
            let mut done = flats.cells.len();
            flats.starts.push(done);
            flats.take(first, &mut open);
            while let Some(&cell) = flats.cells.get(done) {
                for other in offsets.map(|offset| (cell as usize).wrapping_add_signed(offset)) {
                    if open[other] == FLAT {
                        flats.take(other, &mut open);
                    }
                }
                done += 1;
            }
        }
        flats.starts.push(flats.cells.len());
        flats
    }

    fn take(&mut self, cell: usize, open: &mut [u8]) {
        open[cell] = 0;
        self.place[cell] = self.cells.len() as u32;
        self.cells.push(cell as u32);
    }

    /// Runs of flats, each given by the places where they begin and end.
    fn tasks(&self) -> Vec<&[usize]> {
        let mut tasks = Vec::new();
        let mut rest = self.starts.as_slice();
        while let [first, _, ..] = rest {
            let enough =
                rest.partition_point(|start| *start < first + CELLS_PER_TASK).clamp(1, rest.len() - 1);
            tasks.push(&rest[..=enough]);
            rest = &rest[enough..];
        }
        tasks
    }

    fn codes(&self, starts: &[usize], surface: &Surface, codes: &[u8]) -> Vec<u8> {
        let flat = |range: &[usize]| {
            let flat =
                Flat { first: range[0], cells: &self.cells[range[0]..range[1]], flats: self, surface, codes };
            flat.directions()
        };
        starts.windows(2).flat_map(flat).collect()
    }
}

/// Flat ground as each of its cells sees it.
pub(super) struct FlatGround<'a> {
    pub(super) surface: &'a Surface,
    /// Codes of steepest descent.
    pub(super) codes: &'a [u8],
}

impl FlatGround<'_> {
    /// The direction to a neighbour of the same height that drains.
    pub(super) fn drain(&self, cell: usize) -> Option<u8> {
        let level = self.surface.level[cell];
        STRAIGHT_FIRST.into_iter().find(|&code| {
            let other = self.surface.neighbour(cell, code);
            self.codes[other] != FLAT && self.surface.level[other] == level
        })
    }

    /// Whether higher ground lies beside a cell.
    pub(super) fn is_below(&self, cell: usize) -> bool {
        let level = self.surface.level[cell];
        let mut around = self.surface.around(cell).into_iter();
        around.any(|other| self.surface.has_data(other) && self.surface.level[other] > level)
    }

    /// The direction of a cell, by the distances `T` and `A` of the cells of its flat.
    pub(super) fn code(&self, cell: usize, distances: impl Fn(usize) -> [u32; 2]) -> u8 {
        let rank = |&code: &u8| {
            let [towards, away] = distances(self.surface.neighbour(cell, code)).map(i64::from);
            2 * towards - away
        };
        let members = || {
            STRAIGHT_FIRST.into_iter().filter(|&code| self.codes[self.surface.neighbour(cell, code)] == FLAT)
        };
        let best = || members().min_by_key(rank);
        self.drain(cell).or_else(best).expect("a cell of a flat has a neighbour that drains")
    }
}

/// One flat.
struct Flat<'a> {
    first: usize,
    cells: &'a [u32],
    flats: &'a Flats,
    surface: &'a Surface,
    codes: &'a [u8],
}

impl Flat<'_> {
    fn directions(&self) -> Vec<u8> {
        let places = || 0..self.cells.len() as u32;
        let ground = FlatGround { surface: self.surface, codes: self.codes };
        let cell = |place: u32| self.cells[place as usize] as usize;
        let towards = self.distances(places().filter(|&place| ground.drain(cell(place)).is_some()).collect());
        let away = self.distances(places().filter(|&place| ground.is_below(cell(place))).collect());
        let distances = |other: usize| {
            let place = self.flats.place[other] as usize - self.first;
            [towards[place], away[place]]
        };
        places().map(|place| ground.code(cell(place), distances)).collect()
    }

    fn neighbour(&self, place: u32, code: u8) -> usize {
        self.surface.neighbour(self.cells[place as usize] as usize, code)
    }

    /// The place of a neighbour, if it is of the flat.
    fn member(&self, place: u32, code: u8) -> Option<u32> {
        let other = self.neighbour(place, code);
        (self.codes[other] == FLAT).then(|| self.flats.place[other] - self.first as u32)
    }

    /// Steps from the nearest of the starting places, which have 1; 0 where none leads.
    fn distances(&self, mut queue: Vec<u32>) -> Vec<u32> {
        let mut distance = vec![0; self.cells.len()];
        for &place in &queue {
            distance[place as usize] = 1;
        }
        let mut done = 0;
        while let Some(&place) = queue.get(done) {
            for other in (1..=8).filter_map(|code| self.member(place, code)) {
                if distance[other as usize] == 0 {
                    distance[other as usize] = distance[place as usize] + 1;
                    queue.push(other);
                }
            }
            done += 1;
        }
        distance
    }
}
