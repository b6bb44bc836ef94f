//! Fills depressions: each cell rises to the least height that its path to an outlet must pass.
//!
//! Basins are joined over their saddles from the lowest up (Kruskal 1956). When a set of basins is joined with
//! the outside, water in all of them stands as high as that saddle, since all earlier saddles were lower.

use rayon::prelude::*;

use super::basins::Basins;
use super::disjoint_sets::DisjointSets;
use super::saddles::Saddles;
use super::surface::{ROWS_PER_TASK, Surface};

/// Raises the cells of depressions to the height at which they overflow.
pub(super) fn fill(surface: &mut Surface, basins: &Basins, saddles: &Saddles) {
    let spills = spills(basins.count(), saddles.tree.iter().map(|saddle| (saddle.level, saddle.basins)));
    raise(surface, basins, &spills);
}

/// Raises each cell to the height at which its basin overflows. A cell as high keeps its bits, of which zero has two.
pub(super) fn raise(surface: &mut Surface, basins: &Basins, spills: &[f32]) {
    let cells = surface.level.par_iter_mut().zip(&basins.labels);
    cells.with_min_len(ROWS_PER_TASK * surface.stride).for_each(|(level, &basin)| {
        let spill = spills[basin as usize];
        *level = if spill > *level { spill } else { *level };
    });
}

/// The height at which each basin overflows, by the saddles of a spanning tree from the lowest up; basin 0 never fills.
pub(super) fn spills(count: usize, tree: impl Iterator<Item = (f32, [u32; 2])>) -> Vec<f32> {
    let mut spills = vec![f32::NEG_INFINITY; count];
    let mut sets = Sets::new(count);
    for (level, basins) in tree {
        let [a, b] = basins.map(|basin| sets.union.root(basin));
        if a != 0 && b != 0 {
            sets.join(a, b);
            continue;
        }
        let inland = a.max(b);
        sets.members(inland, |basin| spills[basin as usize] = level);
        sets.drain(inland);
    }
    spills
}

/// Sets of basins, each a ring of its members.
struct Sets {
    union: DisjointSets,
    next: Vec<u32>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self { union: DisjointSets::new(count), next: (0..count as u32).collect() }
    }

    fn join(&mut self, a: u32, b: u32) {
        self.union.join([a, b]);
        self.next.swap(a as usize, b as usize);
    }

    /// Makes a set part of the outside. Its ring is not needed any more.
    fn drain(&mut self, root: u32) {
        self.union.join([root, 0]);
    }

    fn members(&self, root: u32, mut each: impl FnMut(u32)) {
        let mut member = root;
        loop {
            each(member);
            member = self.next[member as usize];
            if member == root {
                return;
            }
        }
    }
}
