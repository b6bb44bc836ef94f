//! Which cells lie in a triangle.

use std::ops::RangeInclusive;

use super::delaunay::Point;

/// Calls `visit` with every row that a triangle meets and the columns of its cells there. Cells on edges and corners
/// belong to the triangle.
pub(super) fn for_each_row(triangle: [Point; 3], mut visit: impl FnMut(usize, RangeInclusive<usize>)) {
    let rows = triangle.map(|[_, row]| row);
    let (top, bottom) = (rows[0].min(rows[1]).min(rows[2]), rows[0].max(rows[1]).max(rows[2]));
    for row in top..=bottom {
        let [left, right] = span(triangle, row);
        if left <= right {
            visit(row as usize, left as usize..=right as usize);
        }
    }
}

/// First and last column in a row.
fn span(triangle: [Point; 3], row: u32) -> [i64; 2] {
    let (mut left, mut right) = (i64::MAX, i64::MIN);
    for edge in 0..3 {
        let (a, b) = (triangle[edge], triangle[(edge + 1) % 3]);
        let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        if !(a[1]..=b[1]).contains(&row) {
            continue;
        }
        let [low, high] =
            if a[1] == b[1] { [a[0].min(b[0]), a[0].max(b[0])].map(i64::from) } else { crossing(a, b, row) };
        (left, right) = (left.min(low), right.max(high));
    }
    [left, right]
}

/// The columns to the right and to the left of where a sloping edge crosses a row.
fn crossing(a: Point, b: Point, row: u32) -> [i64; 2] {
    let [ax, ay, bx, by, row] = [a[0], a[1], b[0], b[1], row].map(i64::from);
    let height = by - ay;
    let along = ax * height + (row - ay) * (bx - ax);
    let floor = along.div_euclid(height);
    [floor + i64::from(along.rem_euclid(height) > 0), floor]
}

#[cfg(test)]
mod tests {
    use super::super::delaunay::turn;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_cells_of_a_triangle_are_those_on_the_inner_side_of_its_edges(corners: [[u8; 2]; 3]) {
            let corners = corners.map(|corner| corner.map(|at| u32::from(at % 24)));
            let [a, b, c] = corners;
            prop_assume!(turn(a, b, c) > 0);
            let mut found = Vec::new();
            for_each_row(corners, |row, columns| found.extend(columns.map(|column| [column as u32, row as u32])));
            let inside = |p: &Point| turn(a, b, *p) >= 0 && turn(b, c, *p) >= 0 && turn(c, a, *p) >= 0;
            let cells = (0..24).flat_map(|row| (0..24).map(move |column| [column, row]));
            prop_assert_eq!(found, cells.filter(inside).collect::<Vec<_>>());
        }
    }
}
