//! Gaussian mean of a field, mirrored at the border, cut off at four standard deviations.

/// Values on a grid in double precision.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    /// Cells a row.
    pub(super) columns: usize,
    /// Row-major values.
    pub(super) values: Vec<f64>,
}

/// The mean with weights `exp(-r²/2σ²)`, σ in cells.
pub(super) fn gaussian(grid: &Grid, sigma: f64) -> Grid {
    transposed(&blurred_rows(&transposed(&blurred_rows(grid, sigma)), sigma))
}

fn kernel(sigma: f64) -> Vec<f64> {
    let radius = libm::ceil(4.0 * sigma) as i32;
    let weight = |offset: i32| libm::exp(-0.5 * f64::from(offset * offset) / (sigma * sigma));
    let weights: Vec<f64> = (-radius..=radius).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

fn blurred_rows(grid: &Grid, sigma: f64) -> Grid {
    let kernel = kernel(sigma);
    let radius = (kernel.len() / 2) as isize;
    let blur = |row: &[f64], x: usize| -> f64 {
        let cells = (x as isize - radius..).map(|cell| row[mirror(cell, row.len())]);
        kernel.iter().zip(cells).map(|(weight, value)| weight * value).sum()
    };
    let rows = grid.values.chunks(grid.columns);
    let values = rows.flat_map(|row| (0..row.len()).map(|x| blur(row, x)).collect::<Vec<_>>()).collect();
    Grid { columns: grid.columns, values }
}

/// The cell that stands for a place beyond the border: …, 1, 0 | 0, 1, 2, …
fn mirror(cell: isize, count: usize) -> usize {
    let period = 2 * count as isize;
    let place = cell.rem_euclid(period);
    place.min(period - 1 - place) as usize
}

fn transposed(grid: &Grid) -> Grid {
    let rows = grid.values.len() / grid.columns;
    let column = |x: usize| (0..rows).map(move |y| grid.values[y * grid.columns + x]);
    Grid { columns: rows, values: (0..grid.columns).flat_map(column).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_keeps_the_sum_and_spreads_a_point_by_its_sigma() {
        let mut values = vec![0.0; 61 * 61];
        values[30 * 61 + 30] = 1.0;
        let blurred = gaussian(&Grid { columns: 61, values }, 3.0);
        assert!((blurred.values.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let spread =
            |(cell, value): (usize, &f64)| value * (cell as f64 % 61.0 - 30.0) * (cell as f64 % 61.0 - 30.0);
        let variance: f64 = blurred.values.iter().enumerate().map(spread).sum();
        assert!((variance - 9.0).abs() < 0.05, "{variance}");
    }

    #[test]
    fn the_border_is_mirrored_so_that_flat_ground_stays_level() {
        let blurred = gaussian(&Grid { columns: 3, values: vec![7.0; 6] }, 3.0);
        assert!(blurred.values.iter().all(|value| (value - 7.0).abs() < 1e-12));
    }
}
