//! How much water passes through each cell, as the area whose rain it is, and how unevenly it is spread.

use super::input::NetworkInput;

/// Cells whose mean rain the mean flow of each cell carries, row-major. The flow vector of a cell is the half-sum
/// of the fluxes through its two faces of each axis; none passes the border.
pub(super) fn effective_areas(input: &NetworkInput<'_>) -> Vec<f64> {
    let size = input.ground.size();
    let (east, south) = (input.mean_flux_x, input.mean_flux_y);
    let area = |cell: usize| {
        let (x, y) = (cell % size.columns, cell / size.columns);
        let west = if x > 0 { f64::from(east.at(x - 1, y)) } else { 0.0 };
        let north = if y > 0 { f64::from(south.at(x, y - 1)) } else { 0.0 };
        let flow_x = 0.5 * (west + f64::from(east.at(x, y)));
        let flow_y = 0.5 * (north + f64::from(south.at(x, y)));
        (flow_x * flow_x + flow_y * flow_y).sqrt() / input.mean_rain
    };
    (0..size.cells()).map(area).collect()
}

/// Gini coefficient of amounts, none of them negative: 0 where all are the same, nearly 1 where one has all. 0
/// where there is nothing.
pub(super) fn gini(mut amounts: Vec<f64>) -> f64 {
    amounts.sort_unstable_by(f64::total_cmp);
    let (count, sum) = (amounts.len() as f64, amounts.iter().sum::<f64>());
    if sum <= 0.0 {
        return 0.0;
    }
    let ranked: f64 = amounts.iter().enumerate().map(|(rank, amount)| (rank + 1) as f64 * amount).sum();
    2.0 * ranked / (count * sum) - (count + 1.0) / count
}

#[cfg(test)]
mod tests {
    use super::gini;

    #[test]
    fn the_gini_coefficient_is_zero_for_equals_and_nearly_one_where_one_has_all() {
        assert!(gini(vec![3.0; 50]).abs() < 1e-12);
        let mut one = vec![0.0; 100];
        one[17] = 5.0;
        assert!((gini(one) - 0.99).abs() < 1e-12);
        assert_eq!(gini(vec![0.0; 4]), 0.0);
        // Amounts that rise evenly from 0: the area between the diagonal and a parabola, a third.
        assert!((gini((0..1000).map(f64::from).collect()) - 1.0 / 3.0).abs() < 1e-3);
    }
}
