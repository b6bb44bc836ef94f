//! Outlines of numbered areas along the edges of cells.
//!
//! Each edge between a cell of an area and another is followed with the area on the left, as seen on a map with
//! north up; where two cells of an area meet at a corner alone, it turns left, so that they are two polygons. A
//! ring that passes a corner twice is cut there in two. So shores run counter-clockwise and islands clockwise,
//! rings do not touch themselves, and islands touch shores at single corners at most, as the OGC's simple
//! features (ISO 19125-1) and `GeoJSON` (RFC 7946) want it.

use std::collections::BTreeMap;

use weald_core::connected::areas;
use weald_core::grid::Size;

/// Corner of cells: column and row of the cell south-east of it.
type Corner = (usize, usize);

/// One connected piece of an outline: a shore and islands. Corners are metres eastward from the western and
/// southward from the northern edge of the grid; the last corner of a ring is its first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The shore, counter-clockwise as seen on a map with north up.
    pub shore: Vec<[f64; 2]>,
    /// Islands, clockwise as seen on a map with north up.
    pub islands: Vec<Vec<[f64; 2]>>,
}

/// Steps eastward and southward along an edge: east, north, west, south. A left turn is the next one.
const STEPS: [(isize, isize); 4] = [(1, 0), (0, -1), (-1, 0), (0, 1)];

/// The polygons of each number but 0, in the order of their northernmost cells.
pub(super) fn outlines(size: Size, cell: f64, numbers: &[u32]) -> BTreeMap<u32, Vec<Polygon>> {
    let area = Areas { size, numbers };
    let parts = area.parts();
    let mut found: BTreeMap<u32, Vec<Polygon>> = BTreeMap::new();
    let mut place: BTreeMap<u32, (u32, usize)> = BTreeMap::new();
    let mut rings = Vec::new();
    for (ring, inside) in area.rings() {
        rings.extend(simple_rings(&ring).into_iter().map(|ring| (ring, inside)));
    }
    let in_metres =
        |ring: &[Corner]| corners_only(ring).map(|(x, y)| [x as f64 * cell, y as f64 * cell]).collect();
    for (ring, inside) in rings.iter().filter(|(ring, _)| doubled_area(ring) > 0) {
        let polygons = found.entry(numbers[*inside]).or_default();
        place.insert(parts[*inside], (numbers[*inside], polygons.len()));
        polygons.push(Polygon { shore: in_metres(ring), islands: Vec::new() });
    }
    for (ring, inside) in rings.iter().filter(|(ring, _)| doubled_area(ring) < 0) {
        let (number, at) = place[&parts[*inside]];
        let polygon = found.get_mut(&number).and_then(|polygons| polygons.get_mut(at));
        polygon.expect("a part with an island has a shore").islands.push(in_metres(ring));
    }
    found
}

struct Areas<'a> {
    size: Size,
    numbers: &'a [u32],
}

impl Areas<'_> {
    /// The number of a cell; 0 beyond the grid.
    fn number(&self, x: isize, y: isize) -> u32 {
        let within = |place: isize, count: usize| usize::try_from(place).ok().filter(|&place| place < count);
        let cell = within(x, self.size.columns).zip(within(y, self.size.rows));
        cell.map_or(0, |(x, y)| self.numbers[self.size.index(x, y)])
    }

    /// Cells on the left and on the right of the edge that leaves a corner.
    fn sides(&self, (x, y): Corner, heading: usize) -> (u32, u32) {
        let (x, y) = (x as isize, y as isize);
        let [north_west, north_east, south_west, south_east] =
            [self.number(x - 1, y - 1), self.number(x, y - 1), self.number(x - 1, y), self.number(x, y)];
        match heading {
            0 => (north_east, south_east),
            1 => (north_west, north_east),
            2 => (south_west, north_west),
            _ => (south_east, south_west),
        }
    }

    /// Connected parts of areas, by edges alone: the same number for each cell of one.
    fn parts(&self) -> Vec<u32> {
        let mut parts = vec![0; self.numbers.len()];
        for (cells, part) in areas(self.size, self.numbers).into_iter().zip(1..) {
            for cell in cells {
                parts[cell] = part;
            }
        }
        parts
    }

    /// All rings, each with a cell on its left. Every ring has an edge along the north or the south of a cell:
    /// rings are found at the former or, for islands, the latter, in the order of rows.
    fn rings(&self) -> Vec<(Vec<Corner>, usize)> {
        let mut taken = vec![false; 2 * self.numbers.len()];
        let mut rings = Vec::new();
        for cell in (0..self.numbers.len()).filter(|&cell| self.numbers[cell] > 0) {
            let (x, y) = (cell % self.size.columns, cell / self.size.columns);
            // West along the north of the cell, east along its south.
            for (start, heading, edge) in [((x + 1, y), 2, 2 * cell), ((x, y + 1), 0, 2 * cell + 1)] {
                let (left, right) = self.sides(start, heading);
                if left != right && !taken[edge] {
                    rings.push((self.ring(start, heading, &mut taken), cell));
                }
            }
        }
        rings
    }

    fn ring(&self, start: Corner, first: usize, taken: &mut [bool]) -> Vec<Corner> {
        let (mut corner, mut heading) = (start, first);
        let number = self.sides(start, first).0;
        let mut ring = Vec::new();
        loop {
            ring.push(corner);
            match heading {
                0 => taken[2 * self.size.index(corner.0, corner.1 - 1) + 1] = true,
                2 => taken[2 * self.size.index(corner.0 - 1, corner.1)] = true,
                _ => {}
            }
            let (east, south) = STEPS[heading];
            corner = (corner.0.wrapping_add_signed(east), corner.1.wrapping_add_signed(south));
            let turns = [heading + 1, heading, heading + 3].map(|heading| heading % 4);
            let goes_on = |&heading: &usize| {
                let (left, right) = self.sides(corner, heading);
                left == number && right != number
            };
            heading = turns.into_iter().find(goes_on).expect("an edge that arrives at a corner leaves it");
            if (corner, heading) == (start, first) {
                return ring;
            }
        }
    }
}

/// Cuts a ring where it passes a corner a second time.
fn simple_rings(ring: &[Corner]) -> Vec<Vec<Corner>> {
    let mut simple = Vec::new();
    let mut path: Vec<Corner> = Vec::new();
    let mut place: BTreeMap<Corner, usize> = BTreeMap::new();
    for &corner in ring {
        if let Some(&before) = place.get(&corner) {
            let cut = path.split_off(before);
            for corner in &cut {
                place.remove(corner);
            }
            simple.push(cut);
        }
        place.insert(corner, path.len());
        path.push(corner);
    }
    simple.push(path);
    simple
}

/// Twice the area of a ring in cells: positive where it runs counter-clockwise with north up.
fn doubled_area(ring: &[Corner]) -> i64 {
    let next = ring.iter().cycle().skip(1);
    let cross = |(a, b): (&Corner, &Corner)| b.0 as i64 * a.1 as i64 - a.0 as i64 * b.1 as i64;
    ring.iter().zip(next).map(cross).sum()
}

/// The corners at which a ring turns, and the first of them again.
fn corners_only(ring: &[Corner]) -> impl Iterator<Item = Corner> {
    let count = ring.len();
    let turns = move |&at: &usize| {
        let (before, after) = (ring[(at + count - 1) % count], ring[(at + 1) % count]);
        (before.0 == ring[at].0) != (ring[at].0 == after.0)
    };
    let first = (0..count).find(turns);
    (0..count).filter(turns).chain(first).map(|at| ring[at])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygons(rows: &[&str]) -> BTreeMap<u32, Vec<Polygon>> {
        let size = Size::new(rows[0].len(), rows.len()).expect("legal");
        let numbers: Vec<u32> =
            rows.iter().flat_map(|row| row.bytes().map(|b| u32::from(b - b'0'))).collect();
        outlines(size, 10.0, &numbers)
    }

    fn area(ring: &[[f64; 2]]) -> f64 {
        ring.windows(2).map(|pair| pair[1][0] * pair[0][1] - pair[0][0] * pair[1][1]).sum::<f64>() / 2.0
    }

    fn check(polygons: &[Polygon], cells: usize) {
        let mut total = 0.0;
        for polygon in polygons {
            assert!(area(&polygon.shore) > 0.0, "shores run counter-clockwise");
            total += area(&polygon.shore);
            for island in &polygon.islands {
                assert!(area(island) < 0.0, "islands run clockwise");
                total += area(island);
            }
            for ring in polygon.islands.iter().chain([&polygon.shore]) {
                assert_eq!(ring.first(), ring.last());
                let mut corners: Vec<_> = ring[1..].iter().map(|c| (c[0] as i64, c[1] as i64)).collect();
                corners.sort_unstable();
                assert!(corners.windows(2).all(|pair| pair[0] != pair[1]), "{ring:?} touches itself");
            }
        }
        assert_eq!(total, cells as f64 * 100.0);
    }

    #[test]
    fn a_square_has_four_corners_and_its_area() {
        let found = polygons(&["0000", "0110", "0110"]);
        assert_eq!(found[&1][0].shore.len(), 5);
        check(&found[&1], 4);
    }

    #[test]
    fn an_island_is_a_hole_and_a_pond_on_it_a_polygon() {
        let found = polygons(&["11111", "10001", "10101", "10001", "11111"]);
        assert_eq!((found[&1].len(), found[&1][0].islands.len(), found[&1][1].islands.len()), (2, 1, 0));
        check(&found[&1], 17);
    }

    #[test]
    fn cells_that_meet_at_a_corner_are_two_polygons() {
        let found = polygons(&["10", "01"]);
        assert_eq!(found[&1].len(), 2);
        check(&found[&1], 2);
    }

    #[test]
    fn a_ring_closed_at_a_corner_is_a_shore_with_an_island_that_touches_it() {
        let found = polygons(&["0111", "1001", "1001", "1111"]);
        assert_eq!((found[&1].len(), found[&1][0].islands.len()), (1, 1));
        check(&found[&1], 11);
    }

    #[test]
    fn two_islands_that_meet_at_a_corner_are_two_rings() {
        let found = polygons(&["1111", "1011", "1101", "1111"]);
        assert_eq!((found[&1].len(), found[&1][0].islands.len()), (1, 2));
        check(&found[&1], 14);
    }

    #[test]
    fn neighbours_of_other_numbers_and_random_cells_keep_their_areas() {
        let size = Size::new(40, 30).expect("legal");
        let numbers: Vec<u32> =
            (0..size.cells()).map(|cell| (weald_core::random::hash2(3, cell as i64, 0) % 4) as u32).collect();
        let found = outlines(size, 10.0, &numbers);
        assert_eq!(found.len(), 3);
        for (number, polygons) in found {
            check(&polygons, numbers.iter().filter(|&&other| other == number).count());
        }
    }
}
