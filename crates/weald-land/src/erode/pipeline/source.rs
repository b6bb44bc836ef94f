//! Where the rows of a kernel come from, found by their names.

use super::parts::{Pipeline, Plane};
use super::parts::{Reach, Read, Source};
use crate::erode::links::LinkRow;

/// Rows that say which cells exist and which edges join two of them, and on which cells that depends: a part of a
/// domain has walls around it, where the whole may go on.
const LINKS: [(&str, Reach); 7] = [
    ("valid", Reach([0; 4])),
    ("link_east", Reach([0, 1, 0, 0])),
    ("link_south", Reach([0, 0, 0, 1])),
    ("link_west", Reach([1, 0, 0, 0])),
    ("link_north", Reach([0, 0, 1, 0])),
    ("neighbour_share", Reach([1; 4])),
    ("erodible", Reach([0; 4])),
];

/// Directions, with their cells to the east and to the south.
const DIRECTIONS: [(&str, isize, isize); 4] =
    [("east", 1, 0), ("west", -1, 0), ("south", 0, 1), ("north", 0, -1)];

/// The link that can be read of neighbours too, the only one that says it of cells and not of edges.
pub(super) const VALID: usize = 0;

impl Read {
    /// What a cell depends on that reads this.
    pub(super) fn reach(self, planes: &[Plane]) -> Reach {
        let there = match self.source {
            Source::Plane(plane) => planes[plane].reach,
            Source::Link(link) => LINKS[link].1,
            Source::Constant(_) | Source::Input(_) => Reach::default(),
        };
        there.from(self.east, self.south)
    }
}

/// The row of links with this number.
pub(super) fn link<'a>(links: &LinkRow<'a>, number: usize) -> &'a [f32] {
    let rows = [
        links.valid,
        links.east,
        links.south,
        links.west,
        links.north,
        links.neighbour_share,
        links.erodible,
    ];
    rows[number]
}

impl Pipeline {
    /// The row with this name.
    pub(super) fn find(&self, name: &str, kernel: &str) -> Read {
        if let Some(source) = self.source(name) {
            return Read { source, east: 0, south: 0 };
        }
        let (mut plane, mut east, mut south) = (name, 0, 0);
        while let Some((rest, (_, further_east, further_south))) = last_direction(plane) {
            (plane, east, south) = (rest, east + further_east, south + further_south);
            match self.source(plane) {
                Some(Source::Link(link)) if link != VALID => break,
                Some(source) if east.abs() <= 1 && south.abs() <= 1 => return Read { source, east, south },
                _ => {}
            }
        }
        panic!(
            "the kernel `{kernel}` reads `{name}`, which is no constant, no state before the step, no link, no \
             row that an earlier kernel writes, and no neighbour of one"
        )
    }

    /// The plane with this name; of planes with the same name the last that is written.
    fn source(&self, name: &str) -> Option<Source> {
        let plane = self.planes.iter().rposition(|plane| plane.name == name).map(Source::Plane);
        let input = || self.state.iter().position(|state| state.before == name).map(Source::Input);
        let constant = || self.constants.iter().position(|&constant| constant == name).map(Source::Constant);
        let link = || LINKS.iter().position(|(link, _)| *link == name).map(Source::Link);
        plane.or_else(input).or_else(constant).or_else(link)
    }
}

/// A name without the direction at its end, and the direction.
fn last_direction(name: &str) -> Option<(&str, (&'static str, isize, isize))> {
    let (plane, last) = name.rsplit_once('_')?;
    let direction = DIRECTIONS.into_iter().find(|(direction, ..)| *direction == last)?;
    Some((plane, direction))
}
