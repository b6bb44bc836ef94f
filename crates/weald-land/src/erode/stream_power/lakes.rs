//! Lakes: rivers that end in a pit are led on over the lowest outlet.
//!
//! The cells that drain into one pit are a basin. The lowest saddles between basins are those of a minimum spanning tree of
//! their graph; followed from the base level, it says over which saddle each basin spills. The river is then turned from the
//! saddle down to the pit, so that it runs from the pit to the saddle, and what lies below the saddle is under water (Cordonnier,
//! Bovy and Braun 2019, doi 10.5194/esurf-7-549-2019, their "carving").

use rayon::prelude::*;

use super::mesh::Mesh;
use super::receivers::Receivers;
use crate::flow::disjoint_sets::DisjointSets;

/// The basin of all that drains to the base level, and of what has no data.
const DRAINED: u32 = 0;

/// Not yet known.
const UNKNOWN: u32 = u32::MAX;

/// Pairs of basins that are kept in mind while saddles are looked for.
const CACHED_PAIRS: usize = 1 << 12;

/// One side of a saddle.
#[derive(Clone, Copy, Debug)]
struct Side {
    cell: u32,
    basin: u32,
}

/// A low place between two basins.
#[derive(Clone, Copy, Debug)]
struct Saddle {
    height: f64,
    sides: [Side; 2],
}

impl Saddle {
    /// The two basins, the lower number first.
    fn basins(&self) -> [u32; 2] {
        let [a, b] = self.sides.map(|side| side.basin);
        [a.min(b), a.max(b)]
    }

    /// From the lowest up; of two as high the one that is met first counts as lower.
    fn order(&self, other: &Self) -> std::cmp::Ordering {
        let cells = |saddle: &Self| saddle.sides.map(|side| side.cell);
        self.height.total_cmp(&other.height).then_with(|| cells(self).cmp(&cells(other)))
    }
}

/// Lakes as they stand.
#[derive(Debug)]
pub(super) struct Lakes {
    /// Level of the water over each cell in metres; far below all ground where there is none.
    pub(super) level: Vec<f64>,
    /// Whether there is a lake.
    pub(super) stand: bool,
    basin: Vec<u32>,
}

impl Lakes {
    /// None yet.
    pub(super) fn none(mesh: &Mesh) -> Self {
        let cells = mesh.cells();
        Self { level: vec![f64::NEG_INFINITY; cells], stand: false, basin: vec![UNKNOWN; cells] }
    }

    /// Leads all rivers to the base level, and finds the lakes through which they run.
    ///
    /// Cells that cannot reach the base level keep their pit.
    pub(super) fn drain(&mut self, mesh: &Mesh, heights: &[f64], base: &[bool], receivers: &mut Receivers) {
        let basins = self.find_basins(heights, base, receivers);
        self.stand = basins > 1;
        if !self.stand {
            return;
        }
        let tree = spanning_tree(self.saddles(mesh, heights), basins);
        let mut levels = vec![f64::NEG_INFINITY; basins];
        for (saddle, [below, above]) in outward(&tree, basins) {
            levels[above.basin as usize] = levels[below.basin as usize].max(saddle);
            turn(mesh, receivers, [above.cell, below.cell]);
        }
        let cells = self.level.par_iter_mut().zip(&self.basin).with_min_len(CELLS_PER_TASK);
        cells.for_each(|(level, &basin)| *level = levels[basin as usize]);
    }

    /// Numbers the basin of each cell; gives how many there are, with the one that is drained.
    fn find_basins(&mut self, heights: &[f64], base: &[bool], receivers: &Receivers) -> usize {
        self.basin.fill(UNKNOWN);
        let (mut basins, mut path) = (1, Vec::new());
        for cell in 0..heights.len() {
            let mut end = cell;
            while self.basin[end] == UNKNOWN {
                path.push(end);
                let receiver = receivers.of[end] as usize;
                if receiver == end {
                    break;
                }
                end = receiver;
            }
            let basin = match self.basin[end] {
                UNKNOWN if base[end] || heights[end].is_infinite() => DRAINED,
                UNKNOWN => {
                    basins += 1;
                    basins - 1
                }
                basin => basin,
            };
            path.drain(..).for_each(|on_path| self.basin[on_path] = basin);
        }
        basins as usize
    }

    /// Saddles between all basins beside each other: the lowest of each two is among them, and few others of those two.
    fn saddles(&self, mesh: &Mesh, heights: &[f64]) -> Vec<Saddle> {
        let mut saddles: Vec<Saddle> = Vec::new();
        let mut last = vec![0; CACHED_PAIRS];
        let beside = [0, 1, 2, 3].map(|direction| mesh.offset(direction));
        for cell in mesh.inner() {
            for beside in beside.map(|offset| cell.wrapping_add_signed(offset)) {
                let height = heights[cell].max(heights[beside]);
                if self.basin[cell] == self.basin[beside] || height.is_infinite() {
                    continue;
                }
                let sides = [cell, beside].map(|cell| Side { cell: cell as u32, basin: self.basin[cell] });
                let found = Saddle { height, sides };
                let basins = found.basins();
                let last = &mut last[place_of(basins)];
                match saddles.get_mut(*last).filter(|saddle| saddle.basins() == basins) {
                    Some(known) if found.order(known).is_lt() => *known = found,
                    Some(_) => {}
                    None => {
                        *last = saddles.len();
                        saddles.push(found);
                    }
                }
            }
        }
        saddles
    }
}

/// Cells that one task works on at least; no result depends on it.
const CELLS_PER_TASK: usize = 1 << 14;

/// Where a pair of basins is remembered.
fn place_of([a, b]: [u32; 2]) -> usize {
    a.wrapping_mul(0x9e37_79b1).wrapping_add(b.wrapping_mul(0x85eb_ca6b)) as usize >> 7 & (CACHED_PAIRS - 1)
}

/// The saddles of the tree, from the lowest up.
fn spanning_tree(mut saddles: Vec<Saddle>, basins: usize) -> Vec<Saddle> {
    saddles.sort_unstable_by(Saddle::order);
    let mut sets = DisjointSets::new(basins);
    saddles.retain(|saddle| sets.join(saddle.basins()));
    saddles
}

/// The saddles of the tree in the order in which they are reached from the base level, each with its height and its sides:
/// that into which the water spills, and that of the basin that spills.
fn outward(tree: &[Saddle], basins: usize) -> Vec<(f64, [Side; 2])> {
    let of_basin = OfBasins::new(tree, basins);
    let mut reached = vec![false; basins];
    reached[DRAINED as usize] = true;
    let (mut open, mut found) = (vec![DRAINED], Vec::with_capacity(tree.len()));
    while let Some(here) = open.pop() {
        for saddle in of_basin.of(here).iter().map(|&number| &tree[number as usize]) {
            let [a, b] = saddle.sides;
            let [below, above] = if a.basin == here { [a, b] } else { [b, a] };
            if !reached[above.basin as usize] {
                reached[above.basin as usize] = true;
                open.push(above.basin);
                found.push((saddle.height, [below, above]));
            }
        }
    }
    found
}

/// The saddles of each basin by their numbers: those of one lie beside each other.
struct OfBasins {
    first: Vec<u32>,
    saddles: Vec<u32>,
}

impl OfBasins {
    fn new(tree: &[Saddle], basins: usize) -> Self {
        let mut first = vec![0; basins + 1];
        for basin in tree.iter().flat_map(Saddle::basins) {
            first[basin as usize + 1] += 1;
        }
        for basin in 0..basins {
            first[basin + 1] += first[basin];
        }
        let mut next = first.clone();
        let mut saddles = vec![0; 2 * tree.len()];
        for (number, saddle) in tree.iter().enumerate() {
            for basin in saddle.basins() {
                saddles[next[basin as usize] as usize] = number as u32;
                next[basin as usize] += 1;
            }
        }
        Self { first, saddles }
    }

    fn of(&self, basin: u32) -> &[u32] {
        let [from, to] = [0, 1].map(|more| self.first[basin as usize + more] as usize);
        &self.saddles[from..to]
    }
}

/// Turns the river from a cell down to its pit, so that it runs up to the cell and over the saddle.
fn turn(mesh: &Mesh, receivers: &mut Receivers, [from, to]: [u32; 2]) {
    let (mut cell, mut next) = (from, to);
    loop {
        let before = receivers.of[cell as usize];
        receivers.of[cell as usize] = next;
        let direction = mesh.direction(cell as usize, next as usize);
        receivers.inverse[cell as usize] = mesh.inverse(cell as usize, direction);
        if before == cell {
            return;
        }
        (next, cell) = (cell, before);
    }
}
