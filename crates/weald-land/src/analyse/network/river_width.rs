//! Mean width of rivers, as their area over their length.
//!
//! Through each river cell run a stretch of river cells along its row and one along its column; the shorter is the
//! width there. A cell of a river of width w is 1/w of a cell of its length.

use weald_core::grid::Size;

/// Mean width in cells of the cells that are `river`; `None` without one.
pub(super) fn river_width(size: Size, river: &[bool]) -> Option<f64> {
    let along_rows = runs(size.rows, size.columns, |y, x| river[size.index(x, y)]);
    let along_columns = runs(size.columns, size.rows, |x, y| river[size.index(x, y)]);
    let (mut area, mut length) = (0.0, 0.0);
    for cell in (0..size.cells()).filter(|&cell| river[cell]) {
        let (x, y) = (cell % size.columns, cell / size.columns);
        let width = along_rows[cell].min(along_columns[x * size.rows + y]);
        area += 1.0;
        length += 1.0 / width as f64;
    }
    (area > 0.0).then(|| area / length)
}

/// For each of `count` cells of each of `lines` lines, how many neighbouring members it is among; 0 for others.
fn runs(lines: usize, count: usize, member: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut runs = Vec::with_capacity(lines * count);
    for line in 0..lines {
        let members: Vec<bool> = (0..count).map(|place| member(line, place)).collect();
        for run in members.chunk_by(|a, b| a == b) {
            runs.extend(run.iter().map(|&member| if member { run.len() } else { 0 }));
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn width(member: impl Fn(usize, usize) -> bool) -> Option<f64> {
        let size = Size::new(60, 40).expect("legal");
        let river: Vec<bool> = (0..size.cells()).map(|cell| member(cell % 60, cell / 60)).collect();
        river_width(size, &river)
    }

    #[test]
    fn a_straight_river_is_as_wide_as_it_is_and_a_staircase_of_single_cells_has_width_one() {
        let straight = width(|_, y| (10..13).contains(&y)).expect("a river");
        assert!((straight - 3.0).abs() < 1e-9, "{straight}");
        assert_eq!(width(|x, y| x == y), Some(1.0));
        assert_eq!(width(|_, _| false), None);
    }

    #[test]
    fn a_river_that_widens_half_way_has_the_mean_of_both_widths() {
        let found = width(|x, y| (10..if x < 30 { 12 } else { 14 }).contains(&y)).expect("a river");
        assert!((found - 3.0).abs() < 1e-9, "{found}");
    }
}
