//! The courses of rivers as smooth lines between the centres of cells.
//!
//! From each head a river goes down its drainage ([`Drainage`]) for as long as it is a channel
//! ([`FlowField::is_channel`]) or has only spread, as on a fan, the longest first; where it comes near a longer one it
//! ends on it. Then the line is drawn
//! tight and onto the crest of the flow, again and again, as an active contour (Kass, Witkin, Terzopoulos 1988, "Snakes",
//! doi 10.1007/BF00133570): so it has neither the staircase nor the eight directions of the cells.
//!
//! [`FlowField::is_channel`]: super::flow_field::FlowField::is_channel

mod lines;

use std::collections::{BTreeMap, BTreeSet};

use super::drainage::{Drainage, flow_order};
use super::flow_field::SIDE;
use lines::{RIM, centre, cut_where_they_meet, distance, near, run_out, within_reach};
use weald_core::grid::Size;

/// A river drains at least this many cells, and this share of the grid: a picture bears only so many lines.
const MIN_AREA: f32 = 40.0;
const MIN_SHARE: f32 = 1.0 / 900.0;

/// Shortest river that is drawn, in cells.
const SHORTEST: usize = 8;

/// And of one that leads nowhere.
const SHORTEST_ALONE: usize = 24;

/// Cells over which a river grows to its width.
const GROWTH: f32 = 12.0;

/// Cells before a confluence in which the flow of the greater river is felt.
const BESIDE: usize = 4;

/// Longest path, in cells, through ground where the water is no channel.
const LONGEST_GAP: usize = 8;

/// Cells to either side that are of a channel.
const CHANNEL: i32 = 2;

/// Share of what a channel carried that flows near where it went, if it has only spread: less has run dry.
const SPREAD: f32 = 0.5;

/// Passes that draw a line tight and onto its crest, and those after them that only draw it tight.
const PASSES: usize = 30;
const LAST_PASSES: usize = 6;

/// A point of a river.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    /// Cells from the western and from the northern edge of the grid.
    pub(super) place: [f32; 2],
    /// Cells that it drains; no less than any point above.
    pub(super) area: f32,
    /// Share of its width that it has: a river grows from its head, and dwindles where it runs dry.
    pub(super) share: f32,
}

/// Least area of a river, in cells.
pub(super) fn least_area(size: Size) -> f32 {
    MIN_AREA.max(MIN_SHARE * size.cells() as f32)
}

/// Rivers of `least` cells' area or more, each from its head to where it ends or joins one before it.
pub(super) fn courses(drainage: &Drainage, least: f32) -> Vec<Vec<Reach>> {
    let mut map = Courses { drainage, least, owner: vec![None; drainage.area.len()], lines: Vec::new() };
    for head in map.heads() {
        for piece in map.pieces(&map.path(head)) {
            map.add(&piece);
        }
    }
    map.lines
}

struct Courses<'a> {
    drainage: &'a Drainage,
    least: f32,
    /// The point of a river near each cell: its line and its place on it.
    owner: Vec<Option<(usize, usize)>>,
    lines: Vec<Vec<Reach>>,
}

/// Cells of a river, and the point of another that it joins.
struct Piece {
    cells: Vec<usize>,
    joins: Option<(usize, usize)>,
}

impl Courses<'_> {
    fn is_member(&self, cell: usize) -> bool {
        self.drainage.area[cell] >= self.least
    }

    fn is_rim(&self, cell: usize) -> bool {
        let Size { columns, rows } = self.drainage.flow.size;
        let on_end = |place: usize, count: usize| place < RIM || place + RIM >= count;
        on_end(cell % columns, columns) || on_end(cell / columns, rows)
    }

    /// Cells where rivers begin, those of the longest first.
    fn heads(&self) -> Vec<usize> {
        let downstream = &self.drainage.downstream;
        let order = flow_order(downstream);
        let mut length = vec![0_u32; downstream.len()];
        for &cell in order.iter().rev().filter(|&&cell| self.is_member(cell)) {
            length[cell] = 1 + downstream[cell].map_or(0, |next| length[next]);
        }
        let mut has_river_above = vec![false; downstream.len()];
        for &cell in order.iter().filter(|&&cell| self.is_member(cell)) {
            downstream[cell].into_iter().for_each(|next| has_river_above[next] = true);
        }
        let mut heads: Vec<usize> =
            order.into_iter().filter(|&cell| self.is_member(cell) && !has_river_above[cell]).collect();
        heads.sort_unstable_by_key(|&head| (std::cmp::Reverse(length[head]), head));
        heads
    }

    /// Cells from a head down to the end, without loops. What runs along the border has left.
    fn path(&self, head: usize) -> Vec<usize> {
        let mut path: Vec<usize> = Vec::new();
        let mut seen = BTreeSet::new();
        let mut passed = BTreeMap::new();
        let mut next = Some(head);
        while let Some(cell) = next.filter(|&cell| seen.insert(cell)) {
            let size = self.drainage.flow.size;
            let loops = near(size, centre(size, cell))
                .filter_map(|(_, other)| passed.get(&other).copied())
                .filter(|&at: &usize| at + SHORTEST < path.len())
                .min();
            if let Some(at) = loops {
                path.truncate(at + 1);
                passed.retain(|_, place| *place <= at);
            }
            passed.insert(cell, path.len());
            path.push(cell);
            let on_rim = path.iter().rev().take_while(|&&cell| self.is_rim(cell)).count();
            if on_rim > 3 * RIM {
                path.truncate(path.len() + 1 - on_rim);
                break;
            }
            next = self.drainage.downstream[cell];
        }
        path
    }

    /// The parts of a path where it is a channel, each up to where it comes near a river that is there.
    fn pieces(&self, path: &[usize]) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut cells: Vec<usize> = Vec::new();
        let (mut gap, mut carried) = (0, 0.0);
        for &cell in path {
            if let Some(joins) = self.owner[cell] {
                pieces.push(Piece { cells: std::mem::take(&mut cells), joins: Some(joins) });
                break;
            }
            let flow = &self.drainage.flow;
            if flow.is_channel(cell) {
                (gap, carried) = (0, flow.passing(cell, CHANNEL));
            } else {
                let is_river = cells.len() >= SHORTEST_ALONE;
                let has_spread = is_river && flow.passing(cell, SIDE) >= SPREAD * carried;
                gap = if has_spread { 0 } else { gap + 1 };
            }
            if gap == 0 || !cells.is_empty() {
                cells.push(cell);
            }
            if gap > LONGEST_GAP && !cells.is_empty() {
                cells.truncate(cells.len() - gap);
                pieces.push(Piece { cells: std::mem::take(&mut cells), joins: None });
            }
        }
        cells.truncate(cells.len().saturating_sub(gap));
        pieces.push(Piece { cells, joins: None });
        pieces
    }

    fn add(&mut self, piece: &Piece) {
        let flow = &self.drainage.flow;
        let mut line: Vec<[f32; 2]> = piece.cells.iter().map(|&cell| centre(flow.size, cell)).collect();
        if line.len() < SHORTEST {
            return;
        }
        let end = piece.joins.map(|joins| self.confluence(joins, line[line.len() - 1]));
        line.extend(end);
        self.tighten(&mut line, end.is_some());
        if let Some((other, _)) = piece.joins {
            let other: Vec<_> = self.lines[other].iter().map(|reach| reach.place).collect();
            cut_where_they_meet(&mut line, &other);
        }
        let arrives = end.or_else(|| run_out(&line, flow.size)).is_some();
        if !arrives && line.len() < SHORTEST_ALONE {
            return;
        }
        line.extend(run_out(&line, flow.size).filter(|_| end.is_none()));
        let own = if end.is_some() { BESIDE } else { 0 };
        let line = self.reaches(&piece.cells[..piece.cells.len() - own], &line, arrives);
        self.claim(&line);
        self.lines.push(line);
    }

    /// The points of a line with what passes them: what passes its cells.
    fn reaches(&self, cells: &[usize], line: &[[f32; 2]], arrives: bool) -> Vec<Reach> {
        let mut area = 0.0_f32;
        let reach = |(at, &place): (usize, &[f32; 2])| {
            area = area.max(self.drainage.area[cells[at.min(cells.len() - 1)]]);
            let to_end = if arrives { usize::MAX } else { line.len() - 1 - at };
            Reach { place, area, share: ((at.min(to_end) as f32 + 1.0) / GROWTH).min(1.0) }
        };
        line.iter().enumerate().map(reach).collect()
    }

    /// The point of a river that one near it joins: as far below the nearest as that is away.
    fn confluence(&self, (line, nearest): (usize, usize), from: [f32; 2]) -> [f32; 2] {
        let line = &self.lines[line];
        let away = distance(line[nearest].place, from);
        let below = line[nearest..].iter().find(|reach| distance(reach.place, line[nearest].place) >= away);
        below.unwrap_or(&line[line.len() - 1]).place
    }

    /// Draws a line tight and onto the crest of the flow; where it joins another, its end stays.
    fn tighten(&self, line: &mut [[f32; 2]], joins: bool) {
        let home = line.to_vec();
        let last = line.len() - 1;
        for pass in 0..PASSES + LAST_PASSES {
            let before = line.to_vec();
            for at in 0..=last {
                if at == last && joins {
                    continue;
                }
                let [above, below] = [before[at.saturating_sub(1)], before[(at + 1).min(last)]];
                let ends = at == 0 || at == last;
                let mut place = before[at];
                if !ends {
                    place = [0, 1].map(|axis| 0.25 * (above[axis] + 2.0 * place[axis] + below[axis]));
                }
                if pass < PASSES && !(joins && at + BESIDE > last) {
                    let along = [below[0] - above[0], below[1] - above[1]];
                    let length = distance(above, below).max(f32::MIN_POSITIVE);
                    let across = [-along[1] / length, along[0] / length];
                    let aside = 0.5 * self.drainage.flow.crest(place, across);
                    place = [0, 1].map(|axis| place[axis] + aside * across[axis]);
                }
                line[at] = within_reach(home[at], place);
            }
        }
    }

    /// Marks the cells near a line as its own, each by the nearest point.
    fn claim(&mut self, line: &[Reach]) {
        let size = self.drainage.flow.size;
        let mut nearest = BTreeMap::new();
        for (at, reach) in line.iter().enumerate() {
            for (away, cell) in near(size, reach.place) {
                let known = nearest.entry(cell).or_insert((away, at));
                if away < known.0 {
                    *known = (away, at);
                }
            }
        }
        for (cell, (_, at)) in nearest {
            self.owner[cell] = self.owner[cell].or(Some((self.lines.len(), at)));
        }
    }
}

#[cfg(test)]
mod tests;
