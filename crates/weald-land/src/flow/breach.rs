//! Breaches depressions: channels are cut through their rims, so that water leaves them without a lake.
//!
//! From each pit a channel as deep as the pit leads on until the ground is no higher. Lindsay 2016, "Efficient
//! hybrid breaching-filling sink removal methods for flow path enforcement in digital elevation models", doi
//! 10.1002/hyp.10648. Differs: the channel leads back up the steepest descent from the lowest saddle, over it, and
//! down the other side (the carving of Cordonnier et al. 2019, doi 10.5194/esurf-7-549-2019), not along the way
//! by which a queue came. Depressions that need a deeper cut than allowed are left, to be filled, as in
//! Lindsay's hybrid. The result does not depend on the order of the pits: each cell ends as low as the lowest
//! pit whose channel passes it. A hollow below the sea is drained by a channel as deep as the hollow.

use super::basins::Basins;
use super::saddles::Saddles;
use super::surface::Surface;
use crate::flow::directions::OUTLET;

/// Cuts channels from pits, none of which is deeper than `deepest` metres.
pub(super) fn breach(surface: &mut Surface, basins: &Basins, saddles: &Saddles, deepest: f32) {
    let exits = exits(basins.count(), saddles);
    let ground = surface.level.clone();
    let paths = FlowPaths { ground: &ground, basins, exits: &exits };
    for basin in 1..basins.count() as u32 {
        if paths.deepest_cut(basin) <= deepest {
            paths.cut(basin, surface);
        }
    }
}

/// The exit of a basin.
#[derive(Clone, Copy, Debug, Default)]
struct Exit {
    level: f32,
    /// The cell of the basin at the saddle.
    from: usize,
    /// The cell beyond; the same one where water leaves over the border.
    to: usize,
    /// The basin beyond.
    into: u32,
}

/// Turns the saddles of the tree so that they lead out, from basin 0 inward.
fn exits(count: usize, saddles: &Saddles) -> Vec<Exit> {
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (at, saddle) in saddles.tree.iter().enumerate() {
        for basin in saddle.basins {
            beside[basin as usize].push(at as u32);
        }
    }
    let mut exits = vec![Exit::default(); count];
    let mut open = vec![(0, None)];
    while let Some((basin, arrived_over)) = open.pop() {
        for &at in beside[basin as usize].iter().filter(|&&at| Some(at) != arrived_over) {
            let saddle = &saddles.tree[at as usize];
            let inner = usize::from(saddle.basins[0] == basin);
            let inland = saddle.basins[inner];
            let (from, to) = (saddle.cells[inner], saddle.cells[1 - inner]);
            // A way over the border is stored with its cell inside, whichever end that is.
            exits[inland as usize] = Exit { level: saddle.level, from, to, into: basin };
            open.push((inland, Some(at)));
        }
    }
    exits
}

struct FlowPaths<'a> {
    /// Heights before any cut.
    ground: &'a [f32],
    basins: &'a Basins,
    exits: &'a [Exit],
}

impl FlowPaths<'_> {
    fn pit_level(&self, basin: u32) -> f32 {
        self.ground[self.basins.pits[basin as usize]]
    }

    /// How far below the highest saddle on its way the channel of a pit must lie.
    fn deepest_cut(&self, basin: u32) -> f32 {
        let pit = self.pit_level(basin);
        let (mut highest, mut current) = (pit, basin);
        while current != 0 && (current == basin || self.pit_level(current) > pit) {
            let exit = &self.exits[current as usize];
            highest = highest.max(exit.level);
            current = exit.into;
        }
        highest - pit
    }

    /// Lowers the cells of a channel to its pit, as far as one that is lower already.
    fn cut(&self, basin: u32, surface: &mut Surface) {
        let pit = self.basins.pits[basin as usize];
        let level = self.ground[pit];
        let (mut current, mut path) = (basin, self.across(surface, pit, basin));
        while lower(surface, &path, level) {
            let exit = self.exits[current as usize];
            current = exit.into;
            if exit.to == exit.from {
                return;
            }
            // Basin 0 has land as well: the slopes that descend to the sea.
            if current == 0 || self.pit_level(current) <= level {
                lower(surface, &self.descent(surface, exit.to), level);
                return;
            }
            path = self.across(surface, exit.to, current);
        }
    }

    /// The cells from one of a basin down, and up again to its saddle, from where the two paths part.
    fn across(&self, surface: &Surface, from: usize, basin: u32) -> Vec<usize> {
        let mut down = self.descent(surface, from);
        let mut up = self.descent(surface, self.exits[basin as usize].from);
        while down.len() > 1 && up.len() > 1 && down[down.len() - 2] == up[up.len() - 2] {
            down.pop();
            up.pop();
        }
        down.extend(up.iter().rev().skip(1));
        down
    }

    /// The cells from one down to its pit.
    fn descent(&self, surface: &Surface, from: usize) -> Vec<usize> {
        let down = |&cell: &usize| match self.basins.links[cell] {
            OUTLET => None,
            code => Some(surface.neighbour(cell, code)),
        };
        std::iter::successors(Some(from), down).collect()
    }
}

/// Lowers cells to a level; false where one is lower, since its own way leads on from there. One as low may be of
/// the plateau in which the pit lies, and leads nowhere yet.
fn lower(surface: &mut Surface, cells: &[usize], level: f32) -> bool {
    for &cell in cells {
        if surface.level[cell] < level {
            return false;
        }
        surface.level[cell] = level;
    }
    true
}
