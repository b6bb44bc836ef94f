//! The grass of a landscape: maps from which every set follows, wherever one looks.
//!
//! A landscape has more sets than memory, so none is kept. The ground is cut into squares as large as the room of a set
//! where grass is densest; each square has one place, put off its middle by chance, and a rank. A set stands there if the
//! density is above the rank. Ranks follow the additive recurrence R2 (Roberts 2018, "The unreasonable effectiveness of
//! quasirandom sequences") over columns and rows, so that neighbours differ, and thin grass stands as evenly as thick.
//! All of it is a function of the seed, the square and the maps: tiles together are the whole.
//!
//! The source (Kim and Cho 2009) reads soil, light and density from three images; a cell holds so many sets. Here the maps
//! are those of the landscape, between the centres of cells bilinear. The soil of a meadow differs within a metre, and one plant grows
//! many leaves: sets of a tussock share better or worse soil, and most of them a species ([`Meadow::tussocks`]).

use rayon::prelude::*;

use super::blade::Set;
use super::growth::Bend;
use super::instance::{Instance, Packed};
use super::species::Species;
use weald_core::grid::{Field, Mask, Size};
use weald_core::random::splitmix64;

/// Grass on a landscape.
#[derive(Clone, Debug, PartialEq)]
pub struct Meadow {
    /// What grows; instances name them by their number here.
    pub species: Vec<Species>,
    /// What the bend of a blade means.
    pub bend: Bend,
    /// Seed of all that is chance.
    pub seed: u64,
    /// Sets on a square metre where the density is 1.
    pub densest: f64,
    /// Level of growth, 0 to 4.
    pub level: f32,
    /// Height in metres of what is mown.
    pub mown_height: f32,
    /// Depth of water in metres up to which grass stands.
    pub deepest: f32,
    /// Of the sets of a tussock the share that is of one species, and how much worse the worst soil of tussocks is than the best: 0 to 1.
    pub tussocks: f32,
    /// What the ground says.
    pub maps: Maps,
}

/// Maps of one size, one value a cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Maps {
    /// Side of a cell in metres.
    pub cell: f64,
    /// Cells with data; `None` where all have.
    pub valid: Option<Mask>,
    /// Density of sets, 0 to 1.
    pub density: Field,
    /// How good the soil is, 0 to 1.
    pub soil: Field,
    /// How much light there is, 0 to 1.
    pub light: Field,
    /// For each species the share of it and all before it, 0 to 1; nothing where there is no grass.
    pub shares: Vec<Field>,
    /// Depth of water in metres.
    pub water: Option<Field>,
    /// Where grass is mown, 0 to 1.
    pub mown: Option<Field>,
    /// Where it is trodden down, 0 to 1.
    pub trodden: Option<Field>,
}

/// A rectangle in metres east and south of the north-western corner; its southern and eastern sides are not in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// North-western corner.
    pub low: [f64; 2],
    /// South-eastern corner.
    pub high: [f64; 2],
}

/// Metres from one tussock to the next: those of meadows are some decimetres wide.
const TUSSOCK: f32 = 0.7;

/// Share of a square in which its place lies.
const JITTER: f64 = 0.8;

/// What the ranks of columns and rows go up by, as a share of 2³²: one over the plastic number, and over its square.
const RANK_OF_COLUMN: u32 = 3_242_174_889;
const RANK_OF_ROW: u32 = 2_447_445_414;

/// Squares of a task.
const SQUARES_PER_TASK: usize = 1 << 14;

impl Meadow {
    /// The whole ground.
    pub fn area(&self) -> Area {
        let size = self.maps.density.size();
        let high = [size.columns, size.rows].map(|count| count as f64 * self.maps.cell);
        Area { low: [0.0; 2], high }
    }

    /// All sets in a rectangle, from north to south by their squares.
    pub fn sets(&self, area: &Area) -> Vec<Packed> {
        let side = self.side();
        let square = |along: f64| (along / side).floor() as i64;
        let whole = self.area();
        let [low, high] = [0, 1].map(|axis| (area.low[axis].max(0.0), area.high[axis].min(whole.high[axis])));
        if low.0 >= low.1 || high.0 >= high.1 {
            return Vec::new();
        }
        let columns = square(low.0)..square(low.1) + 1;
        let (first, last) = (square(high.0), square(high.1));
        let at_once = SQUARES_PER_TASK.div_ceil((columns.end - columns.start) as usize);
        let of_row = |row: usize| {
            let (row, mut sets) = (Row::of(self, first + row as i64), Vec::new());
            sets.extend(columns.clone().filter_map(|column| row.set(column)).filter(|set| area.holds(set)));
            sets
        };
        let rows = (0..(last - first + 1) as usize).into_par_iter();
        rows.with_min_len(at_once).map(of_row).collect::<Vec<_>>().concat()
    }

    /// How many sets are to be expected in a rectangle; look before you ask for them.
    pub fn expected(&self, area: &Area) -> f64 {
        let (size, cell) = (self.maps.density.size(), self.maps.cell);
        let share = |axis: usize, at: usize| {
            let (low, high) = (at as f64 * cell, (at + 1) as f64 * cell);
            (area.high[axis].min(high) - area.low[axis].max(low)).max(0.0)
        };
        let cells = |axis: usize, count: usize| {
            let [low, high] = [area.low[axis] / cell, area.high[axis] / cell];
            (low.floor().max(0.0) as usize).min(count)..(high.ceil().max(0.0) as usize).min(count)
        };
        let (columns, rows) = (cells(0, size.columns), cells(1, size.rows));
        let row = |y: usize| -> f64 {
            let of_cell = |x: usize| share(0, x) * f64::from(self.maps.density.row(y)[x]);
            share(1, y) * columns.clone().map(of_cell).sum::<f64>()
        };
        self.densest * rows.map(row).sum::<f64>()
    }

    /// The height of the ground under a set, between the centres of cells; none beyond the outermost.
    pub fn height(ground: &Field, cell: f64, place: [f32; 2]) -> Option<f32> {
        Corners::around(ground.size(), 1.0 / cell, place).map(|corners| corners.value(ground))
    }

    /// Height of a species where so much of it is mown, as a share of its greatest.
    pub(super) fn cut(&self, species: usize, mown: f32) -> f32 {
        1.0 - mown * (1.0 - (self.mown_height / self.species[species].top()).min(1.0))
    }

    /// Side of a square in metres.
    fn side(&self) -> f64 {
        1.0 / self.densest.sqrt()
    }
}

/// What the squares of a row have in common.
struct Row<'a> {
    meadow: &'a Meadow,
    number: i64,
    /// The hash of the seed and the row: with a column it makes [`hash2`](weald_core::random::hash2).
    key: u64,
    side: f64,
    cells_per_metre: f64,
}

impl<'a> Row<'a> {
    fn of(meadow: &'a Meadow, number: i64) -> Self {
        let key = splitmix64(splitmix64(meadow.seed) ^ number as u64);
        Self { meadow, number, key, side: meadow.side(), cells_per_metre: 1.0 / meadow.maps.cell }
    }

    /// The set of a square.
    #[inline]
    fn set(&self, column: i64) -> Option<Packed> {
        let (meadow, maps) = (self.meadow, &self.meadow.maps);
        let bits = splitmix64(self.key ^ column as u64);
        let off = |shift: u32| 0.5 + JITTER * (f64::from((bits >> shift) as u16) / 65536.0 - 0.5);
        let place = [(column as f64 + off(0)) * self.side, (self.number as f64 + off(16)) * self.side];
        let place = place.map(|along| along as f32);
        let corners = Corners::around(maps.density.size(), self.cells_per_metre, place)?;
        if rank(column, self.number) >= corners.value(&maps.density) || !maps.bears(&corners, meadow.deepest)
        {
            return None;
        }
        let share = |map: &Option<Field>| map.as_ref().map_or(0.0, |map| corners.value(map).clamp(0.0, 1.0));
        let tussock = Tussock::of(meadow, place, bits);
        let species = maps.species(&corners, bits, tussock);
        let tuft = Set {
            soil: tussock.soil(corners.value(&maps.soil)),
            light: corners.value(&maps.light),
            level: meadow.level,
            cut: meadow.cut(species, share(&maps.mown)),
            trodden: share(&maps.trodden),
            seed: (bits >> 48) as u32,
        };
        Some(Instance { place, species: species as u32, tuft }.pack())
    }
}

/// What the sets of a tussock share.
#[derive(Clone, Copy)]
struct Tussock {
    /// How much better its soil is than that of the map, where that is neither the best nor the worst.
    better: f32,
    /// The random number by which its species is chosen, and the share of its sets that are of it.
    kind: f32,
    alike: f32,
}

impl Tussock {
    /// The one to which a set belongs: that of one of the four points of a lattice around its place, each by its weight, so that tussocks
    /// reach into each other. The lattice is turned, so that it is none of the cells'.
    #[inline]
    fn of(meadow: &Meadow, [x, y]: [f32; 2], bits: u64) -> Self {
        let turned = [0.8 * x + 0.6 * y, 0.8 * y - 0.6 * x].map(|along| along * (1.0 / TUSSOCK));
        // Of the bits of a set those that nothing else is drawn by.
        let random = [32, 40].map(|shift| f32::from((bits >> shift) as u8) * (1.0 / 256.0));
        let [u, v] = [0, 1].map(|axis| below(turned[axis] + random[axis]) as u32);
        let own = splitmix64(splitmix64(!meadow.seed) ^ (u64::from(u) << 32 | u64::from(v)));
        let random = [own as u16, (own >> 16) as u16].map(|bits| f32::from(bits) * (1.0 / 65536.0));
        let alike = meadow.tussocks;
        Self { better: alike * (random[0] - 0.5), kind: random[1], alike }
    }

    /// Its soil where the map has such a one: in the mean that of the map, and between 0 and 1.
    #[inline]
    fn soil(self, of_the_map: f32) -> f32 {
        let room = of_the_map.min(1.0 - of_the_map);
        of_the_map + self.better * (2.0 * room).clamp(0.0, 1.0)
    }
}

/// The greatest whole number that is not above another: `floor` is a call where processors of all kinds are compiled for.
#[inline]
fn below(number: f32) -> i32 {
    let whole = number as i32;
    whole - i32::from(number < whole as f32)
}

/// The density, 0 to 1, above which a square has a set.
#[inline]
fn rank(column: i64, row: i64) -> f32 {
    let columns = (column as u32).wrapping_mul(RANK_OF_COLUMN);
    let rank = columns.wrapping_add((row as u32).wrapping_mul(RANK_OF_ROW));
    rank as f32 * (1.0 / 4_294_967_296.0)
}

impl Area {
    /// Whether a set stands in it.
    pub fn holds(&self, &[east, south, ..]: &Packed) -> bool {
        let place = [east, south].map(|bits| f64::from(f32::from_bits(bits)));
        (0..2).all(|axis| place[axis] >= self.low[axis] && place[axis] < self.high[axis])
    }
}

/// The four cells around a place, and their weights.
struct Corners {
    cells: [usize; 4],
    along: [f32; 2],
}

impl Corners {
    /// The cells around a place, none beyond the outermost centres: grass stands on the mesh of the centres.
    #[inline]
    fn around(size: Size, cells_per_metre: f64, place: [f32; 2]) -> Option<Self> {
        let [u, v] = place.map(|along| f64::from(along) * cells_per_metre - 0.5);
        if u < 0.0 || v < 0.0 || u >= (size.columns - 1) as f64 || v >= (size.rows - 1) as f64 {
            return None;
        }
        let (x, y) = (u as usize, v as usize);
        let first = size.index(x, y);
        let cells = [first, first + 1, first + size.columns, first + size.columns + 1];
        Some(Self { cells, along: [(u - x as f64) as f32, (v - y as f64) as f32] })
    }

    #[inline]
    fn value(&self, map: &Field) -> f32 {
        let values = map.values();
        let [a, b, c, d] = self.cells.map(|cell| values[cell]);
        let [u, v] = self.along;
        let (north, south) = (a + (b - a) * u, c + (d - c) * u);
        north + (south - north) * v
    }
}

impl Maps {
    /// Whether all cells around are ground, and water is no deeper there.
    #[inline]
    fn bears(&self, corners: &Corners, deepest: f32) -> bool {
        let is_valid = |valid: &Mask| corners.cells.iter().all(|&cell| valid.is_valid_at(cell));
        self.valid.as_ref().is_none_or(is_valid)
            && self.water.as_ref().is_none_or(|water| corners.value(water) <= deepest)
    }

    /// The species that grows there: drawn by the shares of one of the cells, which is drawn by its weight. So the
    /// chance of each goes evenly from cell to cell.
    #[inline]
    fn species(&self, corners: &Corners, bits: u64, tussock: Tussock) -> usize {
        let Some((last, _)) = self.shares.split_last().filter(|(_, others)| !others.is_empty()) else {
            return 0;
        };
        let bits = splitmix64(bits);
        let random = |shift: u32| f32::from((bits >> shift) as u16) * (1.0 / 65536.0);
        let drawn =
            usize::from(random(0) < corners.along[0]) + 2 * usize::from(random(16) < corners.along[1]);
        // The drawn cell may have no grass where its neighbour has.
        let grows = |cell: &usize| last.values()[*cell] > 0.0;
        let cell = [0, 1, 2, 3].map(|turn| corners.cells[drawn ^ turn]).into_iter().find(grows);
        let Some(cell) = cell else { return 0 };
        let chosen = if random(48) < tussock.alike { tussock.kind } else { random(32) };
        self.shares.iter().position(|share| chosen < share.values()[cell]).unwrap_or(self.shares.len() - 1)
    }
}
