//! Ground made as finely as a landscape ever will be, of which each cell has the mean: so a coarse landscape is the mean
//! of a fine one, whatever makes the ground.

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};

/// The finest grid of a landscape over its own ground; `None` where that is the landscape's grid itself.
pub(crate) fn domain(domain: &Domain) -> Option<Domain> {
    let size = domain.finest?;
    let finer = size.columns > domain.size.columns;
    finer.then(|| Domain::new(size, domain.cell / factor(size, domain.size)))
}

/// Means of a field of the finest grid over the cells of `size`.
pub(crate) fn means(fine: &Field, size: Size) -> Field {
    let factor = factor(fine.size(), size);
    let columns: Vec<_> = (0..size.columns).map(|x| parts(x, factor, fine.size().columns)).collect();
    let mut coarse = Field::filled(size, 0.0);
    coarse.values_mut().par_chunks_mut(size.columns).enumerate().for_each(|(y, row)| {
        let rows = parts(y, factor, fine.size().rows);
        for (mean, columns) in row.iter_mut().zip(&columns) {
            *mean = weighted(fine, columns, &rows);
        }
    });
    coarse
}

/// Fine cells a coarse one spans.
fn factor(fine: Size, coarse: Size) -> f64 {
    fine.columns as f64 / coarse.columns as f64
}

/// The fine cells under a coarse one along an axis, and how much of each.
fn parts(cell: usize, factor: f64, count: usize) -> Vec<(usize, f64)> {
    let (start, end) = (cell as f64 * factor, (cell + 1) as f64 * factor);
    let cells = start as usize..(end.ceil() as usize).min(count);
    let parts = cells.map(|at| (at, end.min(at as f64 + 1.0) - start.max(at as f64)));
    // A sliver that rounding leaves of the next cell is none.
    parts.filter(|(_, share)| *share > 1e-9).collect()
}

fn weighted(fine: &Field, columns: &[(usize, f64)], rows: &[(usize, f64)]) -> f32 {
    let (mut sum, mut area) = (0.0, 0.0);
    for &(y, height) in rows {
        let row = fine.row(y);
        for &(x, width) in columns {
            sum += f64::from(row[x]) * width * height;
            area += width * height;
        }
    }
    (sum / area) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(columns: usize, rows: usize) -> Size {
        Size::new(columns, rows).expect("small")
    }

    #[test]
    fn a_cell_is_the_mean_of_what_lies_in_it() {
        let fine = Field::from_values(size(4, 2), vec![1.0, 2.0, 5.0, 6.0, 3.0, 2.0, 5.0, 8.0]);
        assert_eq!(means(&fine, size(2, 1)).values(), [2.0, 6.0]);
        let thirds = Field::from_values(size(3, 3), (0..9).map(|n| n as f32).collect());
        let halves = means(&thirds, size(2, 2));
        assert!((halves.at(0, 0) - (0.0 + 0.5 + 1.5 + 1.0) / 2.25).abs() < 1e-6, "{halves:?}");
        assert!((halves.sum() / 4.0 - 4.0).abs() < 1e-6, "nothing counts twice");
    }

    #[test]
    fn a_plane_keeps_its_slope_at_every_ratio() {
        let fine = Field::from_function(size(60, 40), |x, y| x as f32 + 10.0 * y as f32);
        // Where cells lie on parts of cells, the steps between these are seen.
        for (columns, most) in [(30, 1e-4), (12, 1e-4), (24, 0.56), (45, 1.4)] {
            let coarse = means(&fine, size(columns, columns * 2 / 3));
            let factor = 60.0 / columns as f32;
            let expected = |x: usize| (x as f32 + 0.5) * factor - 0.5;
            for (x, y) in [(0, 0), (columns - 1, 3)] {
                let off = coarse.at(x, y) - (expected(x) + 10.0 * expected(y));
                assert!(off.abs() < most, "{columns}: {off}");
            }
        }
    }
}
