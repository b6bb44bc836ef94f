//! Priority-flood: how high water must stand in every cell to find its path to an outlet.
//!
//! Outlets enter a queue ordered by level; the lowest cell leaves it, and each new neighbour enters at
//! `max(its height, the level of the cell it is reached from)`. Source: Barnes, Lehman and Mulla 2014,
//! "Priority-flood: An optimal depression-filling and watershed-labeling algorithm for digital elevation
//! models", doi 10.1016/j.cageo.2013.04.024, algorithm 1. Differs: outlets may lie inside the grid (lakes),
//! and the cell from which each cell was reached is kept, so that paths to the outlets can be judged.
//!
//! Every level is the height of some cell, so that levels are known beforehand: cells are put in order of their heights once,
//! on all cores, and wait in a list for each level instead of a heap. Only those of the level that is flooded now stand in a
//! heap, by their numbers. The order is that of one heap of levels and cells.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rayon::prelude::*;
use weald_core::grid::Size;

/// No cell, or no level yet.
const NONE: u32 = u32::MAX;

/// Where a cell's water goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flooded {
    /// Level at which water stands when it runs off.
    pub(crate) level: f64,
    /// The next cell on the path to an outlet; the cell itself for an outlet.
    pub(crate) next: usize,
}

/// The cells in the order in which they were flooded, and the flood in each cell; of cells of one level the one with the
/// least number comes first. Where no outlet is reached, a cell's level is infinite.
pub(crate) fn priority_flood(size: Size, height: &[f64], outlets: &[bool]) -> (Vec<usize>, Vec<Flooded>) {
    let levels = Levels::of(height);
    let mut queue = Queue::new(levels.heights.len(), size.cells());
    let mut next = vec![NONE; size.cells()];
    let mut level_of = vec![NONE; size.cells()];
    for cell in (0..size.cells()).filter(|&cell| outlets[cell]) {
        (next[cell], level_of[cell]) = (cell as u32, levels.of_cell[cell]);
        queue.push(cell, levels.of_cell[cell]);
    }
    let mut order = Vec::with_capacity(size.cells());
    while let Some((cell, level)) = queue.pop() {
        order.push(cell);
        for other in size.neighbours(cell) {
            if level_of[other] == NONE {
                (next[other], level_of[other]) = (cell as u32, levels.of_cell[other].max(level));
                queue.push(other, level_of[other]);
            }
        }
    }
    let flooded = |(cell, (&next, &level)): (usize, (&u32, &u32))| match level {
        NONE => Flooded { level: f64::INFINITY, next: cell },
        level => Flooded { level: levels.heights[level as usize], next: next as usize },
    };
    (order, next.par_iter().zip(&level_of).enumerate().map(flooded).collect())
}

/// All heights that there are, lowest first, and the number of each cell's.
struct Levels {
    heights: Vec<f64>,
    of_cell: Vec<u32>,
}

impl Levels {
    fn of(height: &[f64]) -> Self {
        let mut sorted: Vec<(u64, u32)> =
            height.par_iter().enumerate().map(|(cell, &height)| (ordered(height), cell as u32)).collect();
        sorted.par_sort_unstable();
        let (mut heights, mut of_cell) = (Vec::new(), vec![0; height.len()]);
        let mut before = None;
        for (bits, cell) in sorted {
            if before != Some(bits) {
                heights.push(height[cell as usize]);
                before = Some(bits);
            }
            of_cell[cell as usize] = heights.len() as u32 - 1;
        }
        Self { heights, of_cell }
    }
}

/// Bits that are in order as [`f64::total_cmp`] has the numbers.
fn ordered(number: f64) -> u64 {
    let bits = number.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// Cells that wait for their level. Levels only ever rise.
struct Queue {
    /// The level that is flooded now, and its cells.
    level: u32,
    now: BinaryHeap<Reverse<u32>>,
    /// The last cell that came to each level, and the one before each cell.
    last: Vec<u32>,
    before: Vec<u32>,
}

impl Queue {
    fn new(levels: usize, cells: usize) -> Self {
        Self { level: 0, now: BinaryHeap::new(), last: vec![NONE; levels], before: vec![NONE; cells] }
    }

    fn push(&mut self, cell: usize, level: u32) {
        if level == self.level {
            self.now.push(Reverse(cell as u32));
        } else {
            self.before[cell] = self.last[level as usize];
            self.last[level as usize] = cell as u32;
        }
    }

    /// The next cell, and its level.
    fn pop(&mut self) -> Option<(usize, u32)> {
        while self.now.is_empty() {
            self.level += 1;
            let mut cell = *self.last.get(self.level as usize)?;
            while cell != NONE {
                self.now.push(Reverse(cell));
                cell = self.before[cell as usize];
            }
        }
        self.now.pop().map(|Reverse(cell)| (cell as usize, self.level))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::naive::flooded_by_one_heap;
    use weald_core::random::{hash2, unit};

    #[test]
    fn a_bowl_fills_to_its_lowest_rim() {
        let size = Size::square(5).expect("legal");
        let mut height = vec![9.0; 25];
        for cell in [6, 7, 8, 11, 12, 13, 16, 17, 18] {
            height[cell] = 1.0;
        }
        height[2] = 4.0;
        let border: Vec<bool> =
            (0..25).map(|cell| ![6, 7, 8, 11, 12, 13, 16, 17, 18].contains(&cell)).collect();
        let (order, flood) = priority_flood(size, &height, &border);
        assert_eq!(order.len(), 25);
        assert_eq!(flood[12].level, 4.0);
        assert_eq!(flood[6].level, 4.0);
        assert_eq!(flood[0].level, 9.0);
    }

    #[test]
    fn the_order_is_that_of_one_heap_of_all_cells() {
        let size = Size::new(67, 41).expect("legal");
        // Of heights in steps many are alike, without zeros below zero, which `f64::max` does not tell from others; what
        // has no data is infinite.
        let grounds: [fn(f64) -> f64; 4] = [
            |height| height,
            |height| (8.0 * height).trunc() + 0.0,
            |height| if height < 0.2 { f64::INFINITY } else { height },
            |_| -0.0,
        ];
        for (seed, ground) in (0..).zip(grounds) {
            let random = |cell: usize, purpose| unit(hash2(seed, cell as i64, purpose));
            let height: Vec<f64> =
                (0..size.cells()).map(|cell| ground(2.0 * random(cell, 0) - 0.5)).collect();
            for share in [0.0, 0.002, 0.3] {
                let outlets: Vec<bool> = (0..size.cells()).map(|cell| random(cell, 1) < share).collect();
                let expected = flooded_by_one_heap(size, &height, &outlets);
                let same = priority_flood(size, &height, &outlets) == expected;
                assert!(same, "ground {seed}, outlets in a share of {share}");
            }
        }
    }
}
