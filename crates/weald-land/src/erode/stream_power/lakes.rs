//! Lakes: rivers that end in a pit are led on over the lowest outlet.
//!
//! The cells that drain into one pit are a basin. The lowest saddles between basins are those of a minimum spanning tree of
//! their graph; followed from the base level, it says over which saddle each basin spills. The river is then turned from the
//! saddle down to the pit, so that it runs from the pit to the saddle, and what lies below the saddle is under water (Cordonnier,
//! Bovy and Braun 2019, doi 10.5194/esurf-7-549-2019, their "carving").

use super::mesh::Mesh;
use super::order::Order;
use super::receivers::Receivers;
use crate::flow::disjoint_sets::DisjointSets;

/// The basin of all that drains to the base level.
const DRAINED: u32 = 0;

/// A saddle between two basins.
#[derive(Clone, Copy, Debug)]
struct Saddle {
    height: f64,
    cells: [u32; 2],
}

/// Leads all rivers to the base level. Gives the level of the water over each cell in metres where there are lakes, far
/// below all ground where there is none; nothing where no river ends in a pit.
///
/// Cells that cannot reach the base level keep their pit.
pub(super) fn drain(
    mesh: &Mesh,
    heights: &[f64],
    base: &[bool],
    receivers: &mut Receivers,
    order: &Order,
) -> Option<Vec<f64>> {
    let (basin, pits) = basins(base, receivers, order);
    if pits.is_empty() {
        return None;
    }
    let tree = spanning_tree(mesh, heights, &basin, pits.len() + 1);
    let mut levels = vec![f64::NEG_INFINITY; pits.len() + 1];
    for (saddle, [from, to]) in outward(&tree, &basin, pits.len() + 1) {
        levels[basin[from as usize] as usize] = levels[basin[to as usize] as usize].max(saddle);
        turn(mesh, receivers, [from, to]);
    }
    Some(basin.iter().map(|&basin| levels[basin as usize]).collect())
}

/// The number of the basin of each cell, and the pits of those from 1 on.
fn basins(base: &[bool], receivers: &Receivers, order: &Order) -> (Vec<u32>, Vec<u32>) {
    let mut basin = vec![DRAINED; receivers.of.len()];
    let mut pits = Vec::new();
    for &cell in order.downstream.iter().rev() {
        let receiver = receivers.of[cell as usize];
        basin[cell as usize] = if receiver != cell {
            basin[receiver as usize]
        } else if base[cell as usize] {
            DRAINED
        } else {
            pits.push(cell);
            pits.len() as u32
        };
    }
    (basin, pits)
}

/// The saddles of the tree, from the lowest up.
fn spanning_tree(mesh: &Mesh, heights: &[f64], basin: &[u32], basins: usize) -> Vec<Saddle> {
    let mut saddles = Vec::new();
    for cell in mesh.inner().filter(|&cell| heights[cell] < f64::INFINITY) {
        for beside in mesh.around(cell).into_iter().take(4) {
            if basin[cell] != basin[beside] && heights[beside] < f64::INFINITY {
                let height = heights[cell].max(heights[beside]);
                saddles.push(Saddle { height, cells: [cell as u32, beside as u32] });
            }
        }
    }
    saddles.sort_unstable_by(|a, b| a.height.total_cmp(&b.height).then(a.cells.cmp(&b.cells)));
    let mut sets = DisjointSets::new(basins);
    saddles.retain(|saddle| sets.join(saddle.cells.map(|cell| basin[cell as usize])));
    saddles
}

/// The saddles in the order in which they are reached from the base level, each with its height and its cells: that of the
/// basin that spills, and that into which it spills.
fn outward(tree: &[Saddle], basin: &[u32], basins: usize) -> Vec<(f64, [u32; 2])> {
    let mut of_basin = vec![Vec::new(); basins];
    for saddle in tree {
        let [a, b] = saddle.cells;
        of_basin[basin[a as usize] as usize].push((saddle.height, [b, a]));
        of_basin[basin[b as usize] as usize].push((saddle.height, [a, b]));
    }
    let mut reached = vec![false; basins];
    reached[DRAINED as usize] = true;
    let (mut open, mut found) = (vec![DRAINED], Vec::with_capacity(tree.len()));
    while let Some(here) = open.pop() {
        for &(height, [from, to]) in &of_basin[here as usize] {
            let next = basin[from as usize];
            if !reached[next as usize] {
                reached[next as usize] = true;
                open.push(next);
                found.push((height, [from, to]));
            }
        }
    }
    found
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
