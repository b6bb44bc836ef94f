//! The levels at which water leaves the basins at the borders of tiles, by a graph of their saddles.
//!
//! A tile has basins of its own, those that it would have if its neighbours were walls. Of its saddles only those count
//! elsewhere that join basins at its border, or such a basin and the outside; the others are joined within. With the
//! saddles between neighbouring tiles these make the graph, whose minimum spanning tree says how high water stands in each
//! basin at a border. With that level as one more saddle to the outside, a tile alone fills as in the whole.

use super::ground::place;
use super::tiling::Tiling;
use crate::flow::basins::Basins;
use crate::flow::disjoint_sets::DisjointSets;
use crate::flow::fill::{raise, spills};
use crate::flow::saddles::{Saddles, key, number};
use crate::flow::surface::Surface;

/// No node: a basin or a cell that the graph does not have.
const NONE: u32 = u32::MAX;

/// The sea, and what lies beyond the border of the grid and of the data.
const OUTSIDE: u32 = 0;

/// One tile: its surface, and where its water gathers.
pub(super) struct TileBasins {
    surface: Surface,
    basins: Basins,
    saddles: Saddles,
}

impl TileBasins {
    pub(super) fn of(surface: Surface) -> Self {
        let basins = Basins::of(&surface);
        let saddles = Saddles::of(&surface, &basins);
        Self { surface, basins, saddles }
    }
}

/// A saddle in the order of its height: the key of its level, and what it joins.
type Edge = (u32, [u32; 2]);

/// Basins at the borders of tiles, joined by saddles.
pub(super) struct SpillGraph<'a> {
    tiling: &'a Tiling,
    /// The basin of each border cell.
    nodes: Vec<u32>,
    /// The height of each border cell.
    levels: Vec<f32>,
    edges: Vec<Edge>,
    /// Basins so far, with the outside.
    count: u32,
}

impl<'a> SpillGraph<'a> {
    pub(super) fn new(tiling: &'a Tiling) -> Self {
        let cells = tiling.border_cells();
        Self { tiling, nodes: vec![NONE; cells], levels: vec![0.0; cells], edges: Vec::new(), count: 1 }
    }

    /// Adds a tile.
    pub(super) fn add(&mut self, tile: usize, ground: &TileBasins) {
        let mut nodes = vec![NONE; ground.basins.count()];
        nodes[0] = OUTSIDE;
        let window = self.tiling.window(tile);
        for cell in self.tiling.border_of(tile) {
            let (at, border) = (place(&window, 1, cell), self.tiling.border(cell));
            if ground.surface.has_data(at) {
                let node = &mut nodes[ground.basins.labels[at] as usize];
                if *node == NONE {
                    *node = self.count;
                    self.count += 1;
                }
                (self.nodes[border], self.levels[border]) = (*node, ground.surface.level[at]);
            }
        }
        self.join_within(ground, nodes);
    }

    /// Keeps the saddles of a tile that join two of these nodes, each of which stands for a set of basins.
    fn join_within(&mut self, ground: &TileBasins, mut nodes: Vec<u32>) {
        let mut sets = DisjointSets::new(ground.basins.count());
        for saddle in &ground.saddles.tree {
            let joined = saddle.basins.map(|basin| nodes[sets.root(basin) as usize]);
            if !joined.contains(&NONE) {
                self.edges.push((key(saddle.level), joined));
            }
            sets.join(saddle.basins);
            let root = sets.root(saddle.basins[0]);
            nodes[root as usize] = joined[0].min(joined[1]);
        }
    }

    /// The level of each node, from the lowest saddles up.
    pub(super) fn solved(mut self) -> Spills<'a> {
        self.join_tiles();
        let tree = spanning_tree(self.count as usize, self.edges);
        let levels = spills(self.count as usize, tree);
        let of_cells = self.nodes.into_iter().map(|node| levels.get(node as usize).copied());
        Spills {
            tiling: self.tiling,
            of_cells: of_cells.map(|level| level.unwrap_or(f32::NEG_INFINITY)).collect(),
        }
    }

    /// Adds the saddles between neighbouring cells of two tiles, each once.
    fn join_tiles(&mut self) {
        for tile in 0..self.tiling.count() {
            for cell in self.tiling.border_of(tile) {
                let here = self.tiling.border(cell);
                let others = self.tiling.across_from(cell).map(|other| self.tiling.border(other));
                for other in others.filter(|&other| here < other) {
                    let joined = [here, other].map(|cell| self.nodes[cell]);
                    if !joined.contains(&NONE) && joined[0] != joined[1] {
                        let level = self.levels[here].max(self.levels[other]);
                        self.edges.push((key(level), joined));
                    }
                }
            }
        }
    }
}

/// The edges of a minimum spanning tree, from the lowest up.
fn spanning_tree(count: usize, mut edges: Vec<Edge>) -> impl Iterator<Item = (f32, [u32; 2])> {
    edges.sort_unstable();
    edges.dedup();
    let mut sets = DisjointSets::new(count);
    edges.into_iter().filter(move |edge| sets.join(edge.1)).map(|(level, joined)| (number(level), joined))
}

/// How high water stands in the basin of each border cell when it leaves; below everything where it is outside.
pub(super) struct Spills<'a> {
    tiling: &'a Tiling,
    of_cells: Vec<f32>,
}

impl Spills<'_> {
    /// The surface of a tile, filled as in the whole.
    pub(super) fn filled(&self, tile: usize, mut ground: TileBasins) -> Surface {
        let window = self.tiling.window(tile);
        let out = self.tiling.border_of(tile).into_iter().filter_map(|cell| {
            let basin = ground.basins.labels[place(&window, 1, cell)];
            (basin != 0).then(|| (key(self.of_cells[self.tiling.border(cell)]), [basin, 0]))
        });
        let within = ground.saddles.tree.iter().map(|saddle| (key(saddle.level), saddle.basins));
        let edges: Vec<Edge> = out.chain(within).collect();
        let count = ground.basins.count();
        let levels = spills(count, spanning_tree(count, edges));
        raise(&mut ground.surface, &ground.basins, &levels);
        ground.surface
    }
}
