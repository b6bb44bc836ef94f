//! Concavity θ of the rivers: slope falls with upslope area, `S ~ A^-θ`.
//!
//! Source: Flint 1974, "Stream gradient as a function of order, magnitude, and discharge",
//! doi 10.1029/WR010i005p00969. Slopes are those of the flooded ground along D8 flow paths; level places are left out.

use super::drainage::Drainage;
use super::power_law::exponent;

/// Cells below which slopes are those of hillsides.
const MIN_AREA: f64 = 8.0;

/// θ over octaves of area from 8 cells upwards; `None` where fewer than three octaves have ten cells each.
pub(super) fn theta(drainage: &Drainage) -> Option<f64> {
    let sample = |&cell: &usize| {
        let next = drainage.next(cell)?;
        Some([drainage.area[cell], drainage.fall(cell, next) / drainage.step(cell, next)])
    };
    exponent(drainage.order.iter().filter_map(sample), MIN_AREA).map(|exponent| -exponent)
}

#[cfg(test)]
mod tests {
    use super::super::drainage::tests::dry;
    use super::*;

    #[test]
    fn rivers_that_flatten_with_the_root_of_their_area_have_a_concavity_of_a_half() {
        // Area grows by a cell a row; the first row drains over the border.
        let height =
            |_: f64, y: f64| -> f64 { -(1..y as u32).map(|area| 1.0 / f64::from(area).sqrt()).sum::<f64>() };
        let found = theta(&dry(16, 200, height)).expect("five octaves");
        assert!((found - 0.5).abs() < 0.01, "{found}");
    }

    #[test]
    fn an_even_slope_has_no_concavity() {
        let found = theta(&dry(16, 200, |_, y| -y)).expect("five octaves");
        assert!(found.abs() < 1e-9, "{found}");
    }
}
