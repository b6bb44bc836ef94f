//! Upslope sums, tile by tile.
//!
//! A cell is finished when all that give to it are, and its sum adds them in the order of directions, as in the whole.
//! A tile finishes what it can by the sums of the cells around it that are finished, and is visited again when one is
//! finished across its border. A river that crosses a border many times has its tiles read as often, so that they are small
//! ([`Tiling::finer`]), and several are looked at side by side.

use super::borders::Borders;
use super::ground::cells;
use super::planes::MARGIN;
use super::settle::{Passed, Visited, settle_side_by_side};
use super::tiling::Tiling;
use crate::flow::Routed;
use crate::flow::accumulate::{CellWeights, set_directions};
use crate::flow::directions::{Directions, OUTLET, SEA, STEPS, opposite};
use crate::flow::multiple::MultipleFlow;
use crate::flow::multiple_sums::Shares;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::plane::{Plane, Window};
use weald_engine::ranks::agreed;

/// Of a cell of another tile, in place of the number of those for which it waits.
const ELSEWHERE: u8 = u8::MAX;

/// What sums are made of: planes of which [`MARGIN`] rows around the tiles of this rank can be read.
#[derive(Clone, Copy)]
pub struct TiledFlow<'a> {
    /// The tiles.
    pub tiling: &'a Tiling,
    /// Directions as [`route_tiled`](super::route_tiled) writes them.
    pub directions: &'a (dyn Plane<u8> + Sync),
    /// 0 where a cell has no data; every cell has without it.
    pub valid: Option<&'a (dyn Plane<u8> + Sync)>,
    /// What each cell adds; 1 without it.
    pub weight: Option<&'a (dyn Plane<f32> + Sync)>,
    /// The surface without depressions and the exponent, where each cell shares among all lower neighbours.
    pub shared: Option<(&'a (dyn Plane<f32> + Sync), f64)>,
}

/// Takes the sums of a tile.
pub type PutSums<'a> = &'a mut dyn FnMut(&Window, &[f64]) -> Result<(), Error>;

/// Sums over all cells above each cell, to the bit those of [`accumulate`](crate::flow::accumulate()) or, where they are
/// shared, of [`accumulate_multiple`](crate::flow::accumulate_multiple). `put` gets each tile once, in no certain order;
/// `passed` is called after each visit.
///
/// Memory: some 40 bytes for a cell of a tile, 90 with shares, and 16 for each border cell of the small tiles of
/// [`Tiling::finer`].
///
/// # Errors
/// Those of the planes, of `put` and of `passed`; [`Error::Run`] where water flows in a cycle.
pub fn accumulate_tiled(flow: &TiledFlow<'_>, put: PutSums<'_>, passed: Passed<'_>) -> Result<(), Error> {
    let tiling = &flow.tiling.finer();
    let look = |tile, borders: &Borders<Option<f64>>, (): &()| {
        let ground = TileOfSums::read(flow, tiling, tile)?;
        let multiple = ground.multiple(flow);
        Ok(ground.seen(&Giving::of(&ground, multiple.as_ref()), tiling, borders))
    };
    let mut borders = Borders::filled(tiling, None);
    let is_done =
        settle_side_by_side((tiling, &mut borders, &mut ()), look, |tile, seen: Seen, borders, ()| {
            let mut woken = Vec::new();
            for (cell, sum, given) in seen.border {
                let border = tiling.border(cell);
                if borders.at(border).is_none() {
                    borders.set(border, Some(sum));
                    woken.extend(given.into_iter().map(|cell| tiling.tile_of(cell)));
                }
            }
            let window = tiling.window(tile);
            if let Some(sums) = &seen.sums {
                put(&window, sums)?;
            }
            passed(window.size().cells())?;
            Ok(Visited { woken, is_done: seen.sums.is_some() })
        })?;
    let open =
        is_done.iter().position(|is_done| !is_done).map(|tile| tiling.window(tiling.own().start + tile));
    let cycle = open.map_or(Ok(()), |Window { columns, rows }| {
        Err(Error::Run(format!(
            "water flows in a cycle through columns {columns:?}, rows {rows:?}; make the directions with the step `flow`"
        )))
    });
    agreed(tiling.ranks(), cycle)
}

/// A tile with the cells around it, as far as the grid goes.
struct TileOfSums {
    tile: usize,
    own: Window,
    held: Window,
    valid: Option<Mask>,
    weight: Option<Field>,
    codes: Vec<u8>,
    /// Where cells share among all lower neighbours.
    routed: Option<Routed>,
}

/// What each cell gives to its neighbours.
enum Giving<'a> {
    /// All, by one way: a bit for each cell.
    Whole(Vec<u8>),
    Shares(Shares<'a>),
}

impl<'a> Giving<'a> {
    fn of(ground: &TileOfSums, multiple: Option<&'a MultipleFlow<'a>>) -> Self {
        let receiver = |&code: &u8| if code == OUTLET || code == SEA { 0 } else { 1 << (code - 1) };
        multiple.map_or_else(
            || Self::Whole(ground.codes.iter().map(receiver).collect()),
            |multiple| Self::Shares(Shares::of(multiple)),
        )
    }

    fn receivers(&self) -> &[u8] {
        match self {
            Self::Whole(receivers) => receivers,
            Self::Shares(shares) => &shares.receivers,
        }
    }

    fn share(&self, giver: usize, cell: usize, direction: usize) -> f64 {
        match self {
            Self::Whole(_) => 1.0,
            Self::Shares(shares) => shares.share(giver, cell, direction),
        }
    }
}

/// What a look at a tile finds.
struct Seen {
    /// Of its border cells that are finished: the cell, its sum, and the cells of other tiles to which it gives.
    border: Vec<([usize; 2], f64, Vec<[usize; 2]>)>,
    /// All sums, where all are finished.
    sums: Option<Vec<f64>>,
}

/// Sums of a tile and of the cells around it, as far as they are known.
struct TileSums {
    sums: Vec<f64>,
    is_known: Vec<bool>,
    /// Cells of the tile that wait for others.
    open: usize,
}

impl TileOfSums {
    fn read(flow: &TiledFlow<'_>, tiling: &Tiling, tile: usize) -> Result<Self, Error> {
        let own = tiling.window(tile);
        let held = own.grown(MARGIN, tiling.size());
        let size = held.size();
        let valid = flow.valid.map(|valid| valid.read(&held)).transpose()?;
        let weight = flow.weight.map(|weight| weight.read(&held)).transpose()?;
        let codes = flow.directions.read(&held)?;
        let routed = |levels| Routed {
            surface: Field::from_values(size, levels),
            directions: Directions::new(size, codes.clone()),
            upslope_cells: None,
        };
        let routed = flow.shared.map(|(surface, _)| surface.read(&held).map(routed)).transpose()?;
        let flags = |valid: Vec<u8>| valid.into_iter().map(|flag| flag != 0).collect();
        Ok(Self {
            tile,
            own,
            held,
            valid: valid.and_then(|valid| Mask::new(size, flags(valid))),
            weight: weight.map(|values| Field::from_values(size, values)),
            codes,
            routed,
        })
    }

    fn multiple(&self, flow: &TiledFlow<'_>) -> Option<MultipleFlow<'_>> {
        let (_, exponent) = flow.shared?;
        let routed = self.routed.as_ref()?;
        Some(MultipleFlow { routed, valid: self.valid.as_ref(), exponent })
    }

    /// The place of a cell of the grid, given by column and row.
    fn place(&self, [x, y]: [usize; 2]) -> usize {
        self.held.size().index(x - self.held.columns.start, y - self.held.rows.start)
    }

    /// The cell of the grid at a place.
    fn cell(&self, at: usize) -> [usize; 2] {
        let columns = self.held.columns.len();
        [at % columns + self.held.columns.start, at / columns + self.held.rows.start]
    }

    /// The place beside another, to which a way leads: within the grid, or, beside the tile, within what is held.
    fn beside(&self, at: usize, direction: usize) -> usize {
        let (east, south) = STEPS[direction];
        at.wrapping_add_signed(south * self.held.columns.len() as isize + east)
    }

    /// The ways from which a cell of the tile gets something, as bits.
    fn donors(&self, at: usize, receivers: &[u8]) -> u8 {
        let Size { columns, rows } = self.held.size();
        let (x, y) = (at % columns, at / columns);
        let gives = |&direction: &u8| {
            let (east, south) = STEPS[usize::from(direction)];
            x.wrapping_add_signed(east) < columns
                && y.wrapping_add_signed(south) < rows
                && receivers[self.beside(at, usize::from(direction))] >> opposite(direction) & 1 == 1
        };
        (0..8).filter(gives).fold(0, |bits, direction| bits | 1 << direction)
    }

    fn seen(&self, giving: &Giving<'_>, tiling: &Tiling, borders: &Borders<Option<f64>>) -> Seen {
        let found = self.sums(giving, tiling, borders);
        let given = |at: usize| {
            let given =
                set_directions(giving.receivers()[at]).map(|direction| self.cell(self.beside(at, direction)));
            given.filter(|[x, y]| !self.own.columns.contains(x) || !self.own.rows.contains(y)).collect()
        };
        let finished = tiling.border_of(self.tile).into_iter().map(|cell| (cell, self.place(cell)));
        let finished = finished.filter(|&(_, at)| found.is_known[at]);
        let border = finished.map(|(cell, at)| (cell, found.sums[at], given(at))).collect();
        let sums = (found.open == 0).then(|| self.inner().map(|at| found.sums[at]).collect());
        Seen { border, sums }
    }

    /// What is known of the tile, by what is known of the border cells around it.
    fn sums(&self, giving: &Giving<'_>, tiling: &Tiling, borders: &Borders<Option<f64>>) -> TileSums {
        let cells = self.codes.len();
        let own = CellWeights::new(cells, self.valid.as_ref(), self.weight.as_ref());
        let mut found = TileSums { sums: vec![0.0; cells], is_known: vec![false; cells], open: 0 };
        for cell in tiling.ring_of(self.tile) {
            if let Some(sum) = borders.at(tiling.border(cell)) {
                let at = self.place(cell);
                (found.sums[at], found.is_known[at]) = (sum, true);
            }
        }
        let (mut donors, mut waiting) = (vec![0; cells], vec![ELSEWHERE; cells]);
        let mut ready = Vec::new();
        for at in self.inner() {
            donors[at] = self.donors(at, giving.receivers());
            let waits = |&direction: &usize| !found.is_known[self.beside(at, direction)];
            waiting[at] = set_directions(donors[at]).filter(waits).count() as u8;
            ready.extend((waiting[at] == 0).then_some(at));
        }
        found.open = self.own.size().cells();
        while let Some(at) = ready.pop() {
            let received = set_directions(donors[at]).map(|direction| {
                let giver = self.beside(at, direction);
                found.sums[giver] * giving.share(giver, at, direction)
            });
            found.sums[at] = own.at(at) + received.sum::<f64>();
            found.is_known[at] = true;
            found.open -= 1;
            for next in set_directions(giving.receivers()[at]).map(|direction| self.beside(at, direction)) {
                if waiting[next] != ELSEWHERE {
                    waiting[next] -= 1;
                    ready.extend((waiting[next] == 0).then_some(next));
                }
            }
        }
        found
    }

    /// The places of the tile's own cells, row by row.
    fn inner(&self) -> impl Iterator<Item = usize> {
        cells(&self.own).map(|(x, y)| self.place([x, y]))
    }
}
