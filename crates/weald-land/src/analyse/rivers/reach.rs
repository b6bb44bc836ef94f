//! Rivers as lines from springs and confluences to where they end.

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

impl Reach {
    /// Length in metres, seen from above.
    pub fn length(&self) -> f64 {
        let pairs = self.points.windows(2);
        pairs.map(|pair| libm::hypot(pair[1].x - pair[0].x, pair[1].y - pair[0].y)).sum()
    }

    /// Upslope area at the last point that is its own, in m².
    pub(super) fn lowest_area(&self) -> f64 {
        self.points.iter().rev().nth(1).or(self.points.last()).map_or(0.0, |point| point.area)
    }
}
