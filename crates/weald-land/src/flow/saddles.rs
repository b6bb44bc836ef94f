//! The saddles between basins that matter: those of a minimum spanning tree.
//!
//! A saddle is a pair of neighbouring cells of two basins, as high as the higher of them, or a cell from which water
//! can leave over the border. The lowest path between two basins leads over saddles of the minimum spanning tree
//! alone (Hu 1961). Bands of rows first sort out the saddles that are the highest of a cycle within the band, since
//! no such saddle is in the tree (Tarjan's red rule); few are left to be sorted together. Saddles are ordered by
//! height, then by place, so that there is one tree, whatever the bands.

use rayon::prelude::*;

use super::basins::Basins;
use super::disjoint_sets::DisjointSets;
use super::surface::{NO_DATA, Surface};

/// Rows of a band.
const BAND: usize = 32;

/// Bits of a saddle that say where it leads: east, south-east, south, south-west, or out.
const DIRECTION_BITS: u32 = 3;
const OUT: u64 = 4;

/// Pairs of basins that a band remembers, so that a long border between two basins is not kept cell by cell.
const CACHED_PAIRS: usize = 1 << 10;

/// The saddles of the tree, from the lowest up.
#[derive(Debug)]
pub(super) struct Saddles {
    pub(super) tree: Vec<Saddle>,
}

/// A saddle between two basins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Saddle {
    /// Height of the saddle.
    pub(super) level: f32,
    /// A cell of each basin beside the other. For a path out of the grid both are the same cell.
    pub(super) cells: [usize; 2],
    /// The basins; the second is 0 for a way out.
    pub(super) basins: [u32; 2],
}

impl Saddles {
    pub(super) fn of(surface: &Surface, basins: &Basins) -> Self {
        let finder = Finder { surface, basins, offsets: surface.offsets() };
        let bands: Vec<usize> = (1..=surface.size.rows).step_by(BAND).collect();
        let found: Vec<Vec<u64>> = bands
            .into_par_iter()
            .map_init(|| DisjointSets::new(basins.count()), |union, first| finder.of_band(first, union))
            .collect();
        let mut all = found.concat();
        all.par_sort_unstable();
        let mut union = DisjointSets::new(basins.count());
        let saddles = all.into_iter().map(|packed| finder.unpacked(packed));
        Self { tree: saddles.filter(|saddle| union.join(saddle.basins)).collect() }
    }
}

struct Finder<'a> {
    surface: &'a Surface,
    basins: &'a Basins,
    offsets: [isize; 8],
}

impl Finder<'_> {
    /// The saddles of a band that are in the spanning forest of the band.
    fn of_band(&self, first: usize, union: &mut DisjointSets) -> Vec<u64> {
        let last = (first + BAND - 1).min(self.surface.size.rows);
        let mut found = Found::default();
        for y in first..=last {
            let start = y * self.surface.stride + 1;
            let cells = start..start + self.surface.size.columns;
            let is_inland = self.is_inland(y);
            for cell in cells.clone() {
                let at_a_side = cell == cells.start || cell + 1 == cells.end;
                self.beside(cell, !is_inland || at_a_side, &mut found);
            }
        }
        found.saddles.sort_unstable();
        let kept = found.saddles.iter().filter(|&&packed| union.join(self.basins_of(packed)));
        let kept = kept.copied().collect();
        for &packed in &found.saddles {
            union.forget(self.basins_of(packed));
        }
        kept
    }

    /// Whether no cell of a row has one without data beside it, but for the first and the last.
    fn is_inland(&self, y: usize) -> bool {
        let Surface { size, stride, level, .. } = self.surface;
        let mut rows = (y - 1..=y + 1).map(|y| &level[y * stride + 1..][..size.columns]);
        rows.all(|row| row.iter().fold(f32::NEG_INFINITY, |most, &level| most.max(level)) != NO_DATA)
    }

    /// The saddles from a cell to its eastern and southern neighbours, and out where it may lie at the rim.
    fn beside(&self, cell: usize, may_let_out: bool, found: &mut Found) {
        let (level, basin) = (self.surface.level[cell], self.basins.labels[cell]);
        if !self.surface.has_data(cell) {
            return;
        }
        for (direction, &offset) in self.offsets[..4].iter().enumerate() {
            let other = cell.wrapping_add_signed(offset);
            let other_basin = self.basins.labels[other];
            if other_basin != basin && self.surface.has_data(other) {
                let level = self.surface.level[other].max(level);
                found.add([basin, other_basin], packed(level, cell, direction as u64));
            }
        }
        let at_the_rim = || self.surface.around(cell).iter().any(|&other| self.surface.lets_out(other));
        // A pit alone can be the lowest cell of its basin at the rim, but so can any other cell.
        if may_let_out && basin != 0 && at_the_rim() {
            found.add([basin, 0], packed(level, cell, OUT));
        }
    }

    fn cells_of(&self, packed: u64) -> [usize; 2] {
        let cell = (packed as u32 >> DIRECTION_BITS) as usize;
        let direction = packed & ((1 << DIRECTION_BITS) - 1);
        let other =
            if direction == OUT { cell } else { cell.wrapping_add_signed(self.offsets[direction as usize]) };
        [cell, other]
    }

    fn basins_of(&self, packed: u64) -> [u32; 2] {
        let [cell, other] = self.cells_of(packed);
        let out = cell == other;
        [self.basins.labels[cell], if out { 0 } else { self.basins.labels[other] }]
    }

    fn unpacked(&self, packed: u64) -> Saddle {
        let level = number((packed >> 32) as u32);
        Saddle { level, cells: self.cells_of(packed), basins: self.basins_of(packed) }
    }
}

/// A saddle in one number: its height above its place. A cell number needs 29 bits, since a grid has at most
/// 2^28 cells within its ring.
fn packed(level: f32, cell: usize, direction: u64) -> u64 {
    u64::from(key(level)) << 32 | (cell as u64) << DIRECTION_BITS | direction
}

/// Whole numbers in the order of the heights.
pub(super) fn key(level: f32) -> u32 {
    // Both zeros are one height.
    let bits = (level + 0.0).to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

pub(super) fn number(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 { key & !(1 << 31) } else { !key })
}

/// The saddles of a band, without most of those that are higher than another between the same basins.
struct Found {
    saddles: Vec<u64>,
    remembered: Vec<([u32; 2], u64)>,
}

impl Default for Found {
    fn default() -> Self {
        Self { saddles: Vec::new(), remembered: vec![([0; 2], 0); CACHED_PAIRS] }
    }
}

impl Found {
    fn add(&mut self, [a, b]: [u32; 2], packed: u64) {
        let pair = [a.min(b), a.max(b)];
        let place = pair[0].wrapping_mul(0x9e37_79b1) ^ pair[1].wrapping_mul(0x85eb_ca6b);
        let remembered = &mut self.remembered[place as usize >> 7 & (CACHED_PAIRS - 1)];
        if remembered.0 != pair || packed < remembered.1 {
            *remembered = (pair, packed);
            self.saddles.push(packed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_heights_and_give_them_back() {
        let heights = [f32::NEG_INFINITY, -3.5, -1.0e-30, 0.0, 1.0e-30, 2.0, 7.5e8];
        assert!(heights.windows(2).all(|pair| key(pair[0]) < key(pair[1])));
        assert!(heights.iter().all(|&height| number(key(height)) == height));
        assert_eq!(key(-0.0), key(0.0));
    }
}
