//! Rivers: which cells they are, how wide and deep, and as lines from their heads to where they end.
//!
//! A cell is river where the land above it is large enough, and so is all below such a cell: a river goes on
//! until water leaves the grid or the data, or reaches a lake or the sea, by construction. Its size follows
//! from its discharge `Q` by the hydraulic geometry of
//!
//! ```text
//! width = a Q^b        depth = c Q^f
//! ```
//!
//! Leopold and Maddock 1953, "The hydraulic geometry of stream channels and some physiographic implications",
//! doi 10.3133/pp252: b = 0.5, f = 0.4. The coefficients for the mean annual discharge are those of Moody and
//! Troutman 2002, "Characterization of the spatial variability of channel morphology", doi 10.1002/esp.403:
//! a = 7.2, c = 0.27. Orders are Strahler's (1957, doi 10.1029/TR038i006p00913).

mod network;
mod smooth;
mod step;
mod trace;

pub use step::{ENTRY, RiversStep};

use weald_core::error::Error;
use weald_core::landscape::Landscape;

/// The rivers of a landscape as lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rivers {
    /// All reaches, each before the ones that flow into it.
    pub reaches: Vec<Reach>,
}

/// A piece of a river without a confluence inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Reach {
    /// From the upper end to the lower end; at least two. The last point of a reach that joins another, or
    /// reaches a lake or the sea, is in the cell where it does.
    pub points: Vec<RiverPoint>,
    /// Strahler order: 1 without tributaries, one more where two of the same order meet.
    pub order: u32,
    /// Where it begins.
    pub start: Start,
    /// Where it ends.
    pub end: End,
    /// The reach that carries its water on, through a lake if need be: its place in [`Rivers::reaches`].
    pub downstream: Option<usize>,
}

/// A point of a river.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RiverPoint {
    /// Metres eastward from the western edge of the grid.
    pub x: f64,
    /// Metres southward from the northern edge of the grid.
    pub y: f64,
    /// Height of the water in metres; never more than that of the point before.
    pub z: f64,
    /// Width in metres.
    pub width: f64,
    /// Depth in metres.
    pub depth: f64,
    /// Discharge in m³/s.
    pub discharge: f64,
    /// Upslope area in m².
    pub area: f64,
}

/// Where a reach begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// At the head of a river.
    Head,
    /// Where two or more reaches meet.
    Confluence,
    /// At the outlet of the lake of that number.
    Lake(u32),
}

/// Where a reach ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At the border of the grid or of the data.
    Outlet,
    /// In the lake of that number.
    Lake(u32),
    /// In the sea.
    Sea,
    /// In the reach [`Reach::downstream`].
    Confluence,
}

impl Rivers {
    /// Reads the rivers out of the layers that the step `rivers` and the steps before it write: `river`,
    /// `river_width`, `river_depth`, `river_level`, `discharge`, `strahler`, `flow_direction`, `accumulation`,
    /// and `lake` if it is there.
    ///
    /// # Errors
    /// [`Error::Run`] for a layer that is missing, or directions that lead nowhere.
    pub fn of(landscape: &Landscape) -> Result<Self, Error> {
        trace::rivers(landscape)
    }

    /// The main stems: each from a head to an outlet, the sea, an end in a lake without outlet, or its
    /// confluence with a greater one. At a confluence the stem comes from the reach of greatest upslope area.
    /// Every reach is in one stem; each stem lists its reaches from head to end, the longest stems first.
    pub fn stems(&self) -> Vec<Vec<usize>> {
        let main = self.main_tributaries();
        let ends = (0..self.reaches.len())
            .filter(|&reach| self.reaches[reach].downstream.is_none_or(|next| main[next] != Some(reach)));
        let mut stems: Vec<Vec<usize>> = ends
            .map(|end| {
                let mut stem: Vec<_> = std::iter::successors(Some(end), |&reach| main[reach]).collect();
                stem.reverse();
                stem
            })
            .collect();
        let length = |stem: &Vec<usize>| stem.iter().map(|&reach| self.reaches[reach].length()).sum::<f64>();
        stems.sort_by(|a, b| length(b).total_cmp(&length(a)));
        stems
    }

    /// For each reach the one that flows into it and drains most.
    fn main_tributaries(&self) -> Vec<Option<usize>> {
        let mut main: Vec<Option<usize>> = vec![None; self.reaches.len()];
        for (reach, next) in
            self.reaches.iter().enumerate().filter_map(|(at, reach)| Some((at, reach.downstream?)))
        {
            let area = |reach: usize| self.reaches[reach].lowest_area();
            if main[next].is_none_or(|other| area(reach) > area(other)) {
                main[next] = Some(reach);
            }
        }
        main
    }
}

impl Reach {
    /// Length in metres, seen from above.
    pub fn length(&self) -> f64 {
        let pairs = self.points.windows(2);
        pairs.map(|pair| libm::hypot(pair[1].x - pair[0].x, pair[1].y - pair[0].y)).sum()
    }

    /// Upslope area at the last point that is its own, in m².
    fn lowest_area(&self) -> f64 {
        self.points.iter().rev().nth(1).or(self.points.last()).map_or(0.0, |point| point.area)
    }
}
