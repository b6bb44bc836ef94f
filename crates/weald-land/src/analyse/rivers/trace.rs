//! Rivers as lines, from the layers alone.
//!
//! The cells of rivers are a forest along the directions of flow. It is cut at confluences and at the shores of
//! lakes; each piece is a reach.

use std::collections::BTreeMap;

use super::reach::{End, Reach, RiverPoint, Rivers, Start};
use super::smooth::{Node, smooth};
use crate::analyse::lakes;
use crate::flow::directions::Directions;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;

/// No reach.
const NONE: u32 = u32::MAX;

/// Reads the rivers of a landscape.
pub(super) fn rivers(landscape: &Landscape) -> Result<Rivers, Error> {
    let layers = Layers::of(landscape)?;
    let upward = layers.directions.upward(|cell| layers.carries(cell));
    let mut reach_of = vec![NONE; layers.river.values().len()];
    let mut reaches = Vec::new();
    let layers = Layers { places: layers.smooth_places(&upward, landscape.field("height").ok()), ..layers };
    // From the mouths up, so that what a reach flows into is known before it.
    for cell in upward {
        let Some(next) = layers.directions.downstream(cell) else {
            if layers.is_river(cell) {
                layers.trace(cell, End::Outlet, &mut reach_of, &mut reaches);
            }
            continue;
        };
        if !layers.is_river(cell) {
            // A lake passes on what it drains to, for the rivers that flow into it.
            reach_of[cell] = reach_of[next];
            continue;
        }
        if reach_of[cell] == NONE {
            layers.trace(cell, layers.end_in(next), &mut reach_of, &mut reaches);
        }
    }
    Ok(Rivers { reaches })
}

struct Layers<'a> {
    cell: f64,
    directions: Directions,
    lakes: Option<Vec<u32>>,
    river: &'a Field,
    width: &'a Field,
    depth: &'a Field,
    level: &'a Field,
    discharge: &'a Field,
    order: &'a Field,
    upslope: &'a Field,
    /// Where rivers run that pass a cell, in cells; where none is named, in its middle.
    places: BTreeMap<usize, [f64; 2]>,
}

impl<'a> Layers<'a> {
    fn of(landscape: &'a Landscape) -> Result<Self, Error> {
        let domain = &landscape.domain;
        let lakes = landscape.layer("lake").is_ok().then(|| lakes::numbers(landscape)).transpose()?;
        Ok(Self {
            cell: domain.cell,
            directions: Directions::of(landscape.field("flow_direction")?, domain.valid.as_ref())?,
            lakes,
            river: landscape.field("river")?,
            width: landscape.field("river_width")?,
            depth: landscape.field("river_depth")?,
            level: landscape.field("river_level")?,
            discharge: landscape.field("discharge")?,
            order: landscape.field("strahler")?,
            upslope: landscape.field("accumulation")?,
            places: BTreeMap::new(),
        })
    }

    fn is_river(&self, cell: usize) -> bool {
        self.river.values()[cell] > 0.0
    }

    fn lake(&self, cell: usize) -> u32 {
        self.lakes.as_ref().map_or(0, |lakes| lakes[cell])
    }

    /// Whether water of a river passes a cell: of a river, or of a lake or the sea.
    fn carries(&self, cell: usize) -> bool {
        self.is_river(cell) || self.lake(cell) > 0 || self.directions.is_sea(cell)
    }

    /// How a reach ends whose last cell drains to another.
    fn end_in(&self, next: usize) -> End {
        match self.lake(next) {
            _ if self.is_river(next) => End::Confluence,
            0 => End::Sea,
            lake => End::Lake(lake),
        }
    }

    /// Follows a reach from its lowest cell up to a confluence, a lake or its head.
    fn trace(&self, lowest: usize, end: End, reach_of: &mut [u32], reaches: &mut Vec<Reach>) {
        let next = self.directions.downstream(lowest);
        let downstream = next.map(|next| reach_of[next]).filter(|&reach| reach != NONE);
        let mut cells: Vec<usize> = next.into_iter().chain([lowest]).collect();
        let mut cell = lowest;
        let start = loop {
            reach_of[cell] = reaches.len() as u32;
            let rivers: Vec<_> =
                self.directions.upstream(cell).filter(|&other| self.is_river(other)).collect();
            let lake = self.directions.upstream(cell).map(|other| self.lake(other)).find(|&lake| lake > 0);
            match (rivers.as_slice(), lake) {
                (&[above], None) => {
                    cells.push(above);
                    cell = above;
                }
                ([], Some(lake)) => break Start::Lake(lake),
                ([], None) => break Start::Head,
                _ => break Start::Confluence,
            }
        };
        cells.reverse();
        let order = self.order.values()[lowest] as u32;
        reaches.push(Reach {
            points: self.points(&cells, end),
            order,
            start,
            end,
            downstream: downstream.map(|reach| reach as usize),
        });
    }

    fn points(&self, cells: &[usize], end: End) -> Vec<RiverPoint> {
        let places = cells.iter().map(|cell| self.places.get(cell).copied().unwrap_or(self.middle(*cell)));
        let last_own = if end == End::Outlet { cells.len() - 1 } else { cells.len().saturating_sub(2) };
        let point = |(at, [x, y]): (usize, [f64; 2])| {
            // In a lake, the sea or another river a river is what it was where it entered; its water stands as
            // high as the other's.
            let own = cells[at.min(last_own)];
            let of = |field: &Field, cell: usize| f64::from(field.values()[cell]);
            RiverPoint {
                x: x * self.cell,
                y: y * self.cell,
                z: of(self.level, cells[at]).min(of(self.level, own)),
                width: of(self.width, own),
                depth: of(self.depth, own),
                discharge: of(self.discharge, own),
                area: of(self.upslope, own),
            }
        };
        places.enumerate().map(point).collect()
    }

    /// Where the rivers run, of which these are the cells, in the valleys of a ground.
    fn smooth_places(&self, cells: &[usize], ground: Option<&Field>) -> BTreeMap<usize, [f64; 2]> {
        let number: BTreeMap<usize, usize> = cells.iter().enumerate().map(|(at, &cell)| (cell, at)).collect();
        let area = |cell: &usize| self.upslope.values()[*cell];
        let node = |&cell: &usize| {
            let rivers = self.directions.upstream(cell).filter(|&other| self.is_river(other));
            let above = rivers.max_by(|a, b| area(a).total_cmp(&area(b)));
            let below = self.directions.downstream(cell);
            let beside = above.zip(below).filter(|_| self.is_river(cell));
            let beside = beside.and_then(|(above, below)| Some([*number.get(&above)?, *number.get(&below)?]));
            Node { home: self.middle(cell), beside }
        };
        let nodes: Vec<_> = cells.iter().map(node).collect();
        cells.iter().copied().zip(smooth(&nodes, ground)).collect()
    }

    /// The middle of a cell, in cells.
    fn middle(&self, cell: usize) -> [f64; 2] {
        let columns = self.river.size().columns;
        [(cell % columns) as f64 + 0.5, (cell / columns) as f64 + 0.5]
    }
}
