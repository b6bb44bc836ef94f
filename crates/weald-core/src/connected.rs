//! Connected cells: components, and how long one is.

use std::collections::VecDeque;

use crate::grid::Size;

/// The components by edges and corners of the cells that are `member`, each a list of cells, in the order of their
/// first cells.
pub fn components(size: Size, member: &[bool]) -> Vec<Vec<usize>> {
    reached(member.to_vec(), |cell| size.neighbours(cell))
}

/// The components by edges alone of cells of the same number other than 0, as [`components`].
pub fn areas(size: Size, numbers: &[u32]) -> Vec<Vec<usize>> {
    let numbered = numbers.iter().map(|&number| number != 0).collect();
    let aside = |cell: usize, other: usize| {
        cell % size.columns == other % size.columns || cell / size.columns == other / size.columns
    };
    reached(numbered, |cell| {
        size.neighbours(cell).filter(move |&other| aside(cell, other) && numbers[other] == numbers[cell])
    })
}

/// The sets of `open` cells that reach each other by the ways that lead `on` from each.
fn reached<Neighbours: Iterator<Item = usize>>(
    mut open: Vec<bool>,
    on: impl Fn(usize) -> Neighbours,
) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    for start in 0..open.len() {
        if !std::mem::take(&mut open[start]) {
            continue;
        }
        let mut cells = vec![start];
        let mut next = 0;
        while let Some(&cell) = cells.get(next) {
            next += 1;
            cells.extend(on(cell).filter(|&other| std::mem::take(&mut open[other])));
        }
        found.push(cells);
    }
    found
}

/// Steps of the longest shortest way through a component, by a double sweep: the cell farthest from any cell,
/// and the distance of the cell farthest from that one. Exact on trees, a lower bound elsewhere.
pub fn geodesic_length(size: Size, component: &[usize]) -> usize {
    let Some(&any) = component.first() else { return 0 };
    let mut member = vec![false; size.cells()];
    for &cell in component {
        member[cell] = true;
    }
    let (end, _) = farthest(size, &member, any);
    farthest(size, &member, end).1
}

fn farthest(size: Size, member: &[bool], start: usize) -> (usize, usize) {
    let mut open = member.to_vec();
    open[start] = false;
    let mut queue = VecDeque::from([(start, 0)]);
    let mut last = (start, 0);
    while let Some((cell, distance)) = queue.pop_front() {
        last = (cell, distance);
        let reached = size.neighbours(cell).filter(|&other| std::mem::take(&mut open[other]));
        queue.extend(reached.map(|other| (other, distance + 1)));
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(rows: &[&str]) -> (Size, Vec<bool>) {
        let size = Size::new(rows[0].len(), rows.len()).expect("legal");
        (size, rows.iter().flat_map(|row| row.bytes().map(|byte| byte == b'#')).collect())
    }

    #[test]
    fn components_meet_at_corners_but_not_over_gaps_or_the_rim() {
        let (size, member) = drawn(&["#..#", ".#..", "#..#"]);
        let sizes: Vec<_> = components(size, &member).iter().map(Vec::len).collect();
        assert_eq!(sizes, [3, 1, 1]);
    }

    #[test]
    fn areas_meet_at_edges_alone_and_only_where_their_numbers_are_the_same() {
        let size = Size::new(4, 3).expect("legal");
        let found = areas(size, &[1, 1, 2, 0, 0, 1, 2, 0, 3, 0, 0, 2]);
        assert_eq!(found, [vec![0, 1, 5], vec![2, 6], vec![8], vec![11]]);
    }

    #[test]
    fn the_length_of_a_hook_is_counted_along_it() {
        let (size, member) = drawn(&["#####.", "....#.", "#####."]);
        let component = &components(size, &member)[0];
        assert_eq!(geodesic_length(size, component), 8);
    }
}
