//! The levels at which water leaves the basins at the borders of tiles, by a graph of their saddles.
//!
//! A tile has basins of its own, those that it would have if its neighbours were walls. Of its saddles only those count
//! elsewhere that join basins at its border, or such a basin and the outside; the others are joined within. With the
//! saddles between neighbouring tiles these make the graph, whose minimum spanning tree says how high water stands in each
//! basin at a border. With that level as one more saddle to the outside, a tile alone fills as in the whole.

use std::ops::Range;

use super::ground::place;
use super::tiling::Tiling;
use crate::flow::basins::Basins;
use crate::flow::disjoint_sets::DisjointSets;
use crate::flow::fill::{raise, spills};
use crate::flow::saddles::{Saddles, key, number};
use crate::flow::surface::Surface;
use weald_core::error::Error;
use weald_engine::ranks::{Reader, Writer};

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

/// Basins at the borders of tiles, joined by saddles: those of this rank's tiles, and then on the first rank those of all.
pub(super) struct SpillGraph<'a> {
    tiling: &'a Tiling,
    /// Number of the first border cell.
    first: usize,
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
        Self::of(tiling, &tiling.own())
    }

    fn of(tiling: &'a Tiling, tiles: &Range<usize>) -> Self {
        let cells = tiling.borders_of(tiles);
        let (nodes, levels) = (vec![NONE; cells.len()], vec![0.0; cells.len()]);
        Self { tiling, first: cells.start, nodes, levels, edges: Vec::new(), count: 1 }
    }

    /// Adds a tile.
    pub(super) fn add(&mut self, tile: usize, ground: &TileBasins) {
        let mut nodes = vec![NONE; ground.basins.count()];
        nodes[0] = OUTSIDE;
        let window = self.tiling.window(tile);
        for cell in self.tiling.border_of(tile) {
            let (at, border) = (place(&window, 1, cell), self.tiling.border(cell) - self.first);
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

    /// The level of each node, from the lowest saddles up: found by the first rank for the tiles of all.
    ///
    /// # Errors
    /// [`Error::Run`] where another rank can no longer be reached.
    pub(super) fn solved(self) -> Result<Spills<'a>, Error> {
        let tiling = self.tiling;
        let ranks = tiling.ranks();
        let mut whole = if ranks.leads() { Some(Self::of(tiling, &(0..tiling.count()))) } else { None };
        ranks.collect(self.message(), &mut |rank, message| {
            whole.iter_mut().try_for_each(|whole| whole.take(rank, &message))
        })?;
        let levels = whole.map(Self::levels).unwrap_or_default();
        let own = ranks.deal(&mut |rank| {
            let mut writer = Writer::default();
            writer.singles(&levels[tiling.borders_of(&tiling.own_of(rank))]);
            writer.0
        })?;
        let mut of_cells = vec![0.0; tiling.borders_of(&tiling.own()).len()];
        Reader(&own).singles(&mut of_cells)?;
        Ok(Spills { tiling, first: self.first, of_cells })
    }

    /// The graph of this rank's tiles.
    fn message(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.words(&[self.count]);
        writer.words(&self.nodes);
        writer.singles(&self.levels);
        self.edges.iter().for_each(|&(level, [one, other])| writer.words(&[level, one, other]));
        writer.0
    }

    /// Adds that of a rank, whose nodes get numbers of their own.
    fn take(&mut self, rank: usize, message: &[u8]) -> Result<(), Error> {
        let cells = self.tiling.borders_of(&self.tiling.own_of(rank));
        let mut reader = Reader(message);
        let (count, known) = (reader.words(1)?[0], self.count - 1);
        let of_all = |node: u32| if node == NONE || node == OUTSIDE { node } else { node + known };
        for (node, own) in self.nodes[cells.clone()].iter_mut().zip(reader.words(cells.len())?) {
            *node = of_all(own);
        }
        reader.singles(&mut self.levels[cells])?;
        while !reader.is_empty() {
            let edge = reader.words(3)?;
            self.edges.push((edge[0], [of_all(edge[1]), of_all(edge[2])]));
        }
        self.count += count - 1;
        Ok(())
    }

    /// The level of the basin of each border cell of the whole.
    fn levels(mut self) -> Vec<f32> {
        self.join_tiles();
        let tree = spanning_tree(self.count as usize, self.edges);
        let levels = spills(self.count as usize, tree);
        let of_cells = self.nodes.into_iter().map(|node| levels.get(node as usize).copied());
        of_cells.map(|level| level.unwrap_or(f32::NEG_INFINITY)).collect()
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
    /// Number of the first border cell of this rank's tiles.
    first: usize,
    of_cells: Vec<f32>,
}

impl Spills<'_> {
    /// The surface of a tile, filled as in the whole.
    pub(super) fn filled(&self, tile: usize, mut ground: TileBasins) -> Surface {
        let window = self.tiling.window(tile);
        let out = self.tiling.border_of(tile).into_iter().filter_map(|cell| {
            let basin = ground.basins.labels[place(&window, 1, cell)];
            (basin != 0).then(|| (key(self.of_cells[self.tiling.border(cell) - self.first]), [basin, 0]))
        });
        let within = ground.saddles.tree.iter().map(|saddle| (key(saddle.level), saddle.basins));
        let edges: Vec<Edge> = out.chain(within).collect();
        let count = ground.basins.count();
        let levels = spills(count, spanning_tree(count, edges));
        raise(&mut ground.surface, &ground.basins, &levels);
        ground.surface
    }
}
