//! Basins: the cells that descend to the same pit.
//!
//! On flat ground, where no neighbour is lower, a cell drains to an equal neighbour of smaller number: cells
//! are then in one strict order, so that no path is a cycle, and a plateau has few pits. Basin 0 is the sea and
//! what lies beyond the border.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

use super::descent::{Descent, FLAT};
use super::surface::{ROWS_PER_TASK, Surface};
use crate::flow::directions::OUTLET;

/// Not yet known.
const UNKNOWN: u32 = u32::MAX;

/// Codes of the neighbours of smaller number: west, north-west, north, north-east.
const BEFORE: [u8; 4] = [5, 6, 7, 8];

/// The basin of each cell.
#[derive(Debug)]
pub(super) struct Basins {
    /// The code by which each cell descends, with the ring; [`OUTLET`] for pits, sea and no-data.
    pub(super) links: Vec<u8>,
    /// The basin of each cell, with the ring.
    pub(super) labels: Vec<u32>,
    /// The pit of each basin; meaningless for basin 0.
    pub(super) pits: Vec<usize>,
}

impl Basins {
    pub(super) fn of(surface: &Surface) -> Self {
        let mut links = Descent::of(surface).codes;
        level_links(surface, &mut links);
        let is_pit = |cell: usize| links[cell] == OUTLET && surface.level[cell].is_finite();
        let pits: Vec<usize> = (0..surface.cells()).into_par_iter().filter(|&cell| is_pit(cell)).collect();
        let labels: Vec<AtomicU32> = links
            .par_iter()
            .with_min_len(ROWS_PER_TASK * surface.stride)
            .map(|&link| AtomicU32::new(if link == OUTLET { 0 } else { UNKNOWN }))
            .collect();
        pits.par_iter().enumerate().for_each(|(basin, &pit)| labels[pit].store(basin as u32 + 1, Relaxed));
        let paths = FlowPaths { links: &links, offsets: surface.offsets(), labels: &labels };
        (0..surface.cells())
            .into_par_iter()
            .with_min_len(ROWS_PER_TASK * surface.stride)
            .for_each(|cell| paths.label(cell));
        let labels = labels.into_iter().map(AtomicU32::into_inner).collect();
        let pits = std::iter::once(0).chain(pits).collect();
        Self { links, labels, pits }
    }

    /// Number of basins, with basin 0.
    pub(super) fn count(&self) -> usize {
        self.pits.len()
    }
}

/// Replaces the codes of cells without a lower neighbour.
fn level_links(surface: &Surface, links: &mut [u8]) {
    let rows = links.par_chunks_mut(surface.stride).enumerate();
    rows.with_min_len(ROWS_PER_TASK).for_each(|(y, row)| {
        for (x, link) in row.iter_mut().enumerate() {
            let cell = y * surface.stride + x;
            if *link == FLAT || (*link == OUTLET && surface.level[cell].is_finite()) {
                let equal = |&code: &u8| surface.level[surface.neighbour(cell, code)] == surface.level[cell];
                *link = BEFORE.into_iter().find(equal).unwrap_or(OUTLET);
            }
        }
    });
}

/// Paths downward. Several threads may follow the same way: they write the same numbers.
struct FlowPaths<'a> {
    links: &'a [u8],
    offsets: [isize; 8],
    labels: &'a [AtomicU32],
}

impl FlowPaths<'_> {
    fn label(&self, cell: usize) {
        let (mut end, mut label) = (cell, self.labels[cell].load(Relaxed));
        while label == UNKNOWN {
            end = self.next(end);
            label = self.labels[end].load(Relaxed);
        }
        let mut on_the_way = cell;
        while self.labels[on_the_way].load(Relaxed) == UNKNOWN {
            self.labels[on_the_way].store(label, Relaxed);
            on_the_way = self.next(on_the_way);
        }
    }

    fn next(&self, cell: usize) -> usize {
        cell.wrapping_add_signed(self.offsets[usize::from(self.links[cell]) - 1])
    }
}
